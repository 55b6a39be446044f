/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Packs contact problems into the groups of the reference's sweeps. */
#include "common/array.h"
#include "reference/reference_units.h"
#include "sweeps/colours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    SECOND_POINT = -1, /* in Reference.rounds: visited with the previous contact */
    NUMBERS = 4        /* for each impulse */
};

void reference_free(Reference *reference) {
    free(reference->velocities);
    free(reference->impulses);
    free(reference->groups);
    free(reference->momenta);
    free(reference->numbers);
    free(reference->rounds);
    free(reference->taken);
    *reference = (Reference){0};
}

static bool reserve(Reference *r, const ContactProblem *problem) {
    size_t bodies = (size_t)problem->body_count + 1, contacts = (size_t)problem->contact_count + 1;
    return array_reserve((void **)&r->velocities, &r->velocity_capacity, bodies, sizeof *r->velocities) &&
           array_reserve((void **)&r->impulses, &r->impulse_capacity, contacts, sizeof *r->impulses) &&
           array_reserve((void **)&r->momenta, &r->momenta_capacity, 3 * bodies, sizeof *r->momenta) &&
           array_reserve((void **)&r->rounds, &r->round_capacity, contacts, sizeof *r->rounds) &&
           array_reserve((void **)&r->taken, &r->taken_capacity, bodies, sizeof *r->taken);
}

static bool reserve_groups(Reference *r, int count) {
    size_t groups = (size_t)count + 1;
    r->group_count = count;
    return array_reserve((void **)&r->groups, &r->group_capacity, groups, sizeof *r->groups) &&
           array_reserve((void **)&r->numbers, &r->number_capacity, NUMBERS * groups, sizeof *r->numbers);
}

static bool same_pair(const ContactPoint *x, const ContactPoint *y) { return x->a == y->a && x->b == y->b; }

/* Pairs of the last round may share bodies: there, one pair per group. */
static int lanes_of(int round) { return round < COLOURS - 1 ? REFERENCE_LANES : 1; }

/* A round is a colour (sweeps/colours.h): its pairs share no moving body. Returns the number of groups. */
static int find_rounds(Reference *r, const ContactProblem *problem) {
    int pairs[COLOURS] = {0}, groups = 0;
    memset(r->taken, 0, (size_t)problem->body_count * sizeof *r->taken);
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        bool second = i > 0 && same_pair(contact, contact - 1) && r->rounds[i - 1] != SECOND_POINT;
        r->rounds[i] = second ? SECOND_POINT : colours_take(r->taken, problem, contact);
        if (!second && pairs[r->rounds[i]]++ % lanes_of(r->rounds[i]) == 0) groups++;
    }
    return groups;
}

/* Half a row: the effect of an impulse along x, y on one body. The velocity of a static body is added to the target. */
static void load_half(ReferenceRow *row, double half[3][REFERENCE_LANES], int lane, double scale,
                      const ProblemBody *body, Vec2 arm, double x, double y) {
    const double inverse[] = {(double)body->inv_mass, (double)body->inv_mass, (double)body->inv_inertia};
    const double velocity[] = {(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity};
    const double along[] = {x, y, (double)arm.x * y - (double)arm.y * x};
    for (int i = 0; i < 3; i++) {
        if (inverse[i] == 0) row->target[lane] -= scale * along[i] * velocity[i];
        half[i][lane] = scale * sqrt(inverse[i]) * along[i];
    }
}

static void load_row(ReferenceRow *row, int lane, const ContactProblem *problem, const ContactPoint *contact, double x,
                     double y, double scale, double target) {
    row->to_velocity[lane] = 1 / scale;
    row->target[lane] = scale * target;
    load_half(row, row->a, lane, scale, &problem->bodies[contact->a], contact->arm_a, -x, -y);
    load_half(row, row->b, lane, scale, &problem->bodies[contact->b], contact->arm_b, x, y);
}

static void load_contact(ReferenceGroup *group, int k, int lane, const ContactProblem *problem, int index) {
    const ContactPoint *contact = &problem->contacts[index];
    ReferenceImpulse scale = reference_scale(contact);
    double x = (double)contact->normal.x, y = (double)contact->normal.y;
    group->contacts[k][lane] = index;
    group->a[lane] = contact->a;
    group->b[lane] = contact->b;
    load_row(&group->rows[2 * k], lane, problem, contact, x, y, scale.normal, (double)contact->bias);
    load_row(&group->rows[2 * k + 1], lane, problem, contact, y, -x, scale.tangent, 0);
    group->friction[k][lane] = (double)contact->friction * scale.normal / scale.tangent;
}

static double row_times_row(const ReferenceRow *x, const ReferenceRow *y, int lane) {
    double sum = 0;
    for (int i = 0; i < 3; i++) sum += x->a[i][lane] * y->a[i][lane] + x->b[i][lane] * y->b[i][lane];
    return sum;
}

static void couple(ReferenceGroup *group, int lane) {
    for (int row = 0, at = 0; row < REFERENCE_ROWS; row++)
        for (int earlier = 0; earlier < row; earlier++)
            group->coupling[at++][lane] = row_times_row(&group->rows[row], &group->rows[earlier], lane);
}

static void clear_group(ReferenceGroup *group, int spare_body) {
    memset(group, 0, sizeof *group);
    for (int lane = 0; lane < REFERENCE_LANES; lane++) {
        group->a[lane] = group->b[lane] = spare_body;
        for (int k = 0; k < REFERENCE_POINTS; k++) group->contacts[k][lane] = -1;
    }
}

/* The groups of one round, from *group on. */
static void load_round(Reference *r, const ContactProblem *problem, int round, ReferenceGroup **group) {
    int lane = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        if (r->rounds[i] != round) continue;
        if (lane == 0) clear_group(*group, problem->body_count);
        load_contact(*group, 0, lane, problem, i);
        if (i + 1 < problem->contact_count && r->rounds[i + 1] == SECOND_POINT)
            load_contact(*group, 1, lane, problem, i + 1);
        couple(*group, lane);
        lane = (lane + 1) % lanes_of(round);
        if (lane == 0) ++*group;
    }
    if (lane > 0) ++*group;
}

bool reference_load(Reference *r, const ContactProblem *problem) {
    if (!reserve(r, problem) || !reserve_groups(r, find_rounds(r, problem))) return false;
    r->body_count = problem->body_count;
    r->momenta_before = r->momenta + problem->body_count + 1;
    r->momenta_direction = r->momenta_before + problem->body_count + 1;
    ReferenceNumbers **rows[NUMBERS] = {&r->sums, &r->sums_before, &r->steps, &r->direction};
    for (int i = 0; i < NUMBERS; i++) *rows[i] = r->numbers + i * r->group_count;
    ReferenceGroup *group = r->groups;
    for (int round = 0; round < COLOURS && group < r->groups + r->group_count; round++)
        load_round(r, problem, round, &group);
    return true;
}
