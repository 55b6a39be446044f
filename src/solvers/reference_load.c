/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact problems into the units of the reference's sweeps, and back. */
#include "common/array.h"
#include "solvers/reference_units.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 64 }; /* bits of Reference.taken */

void reference_free(Reference *reference) {
    free(reference->velocities);
    free(reference->momenta);
    free(reference->momenta_before);
    free(reference->momenta_direction);
    free(reference->contacts);
    free(reference->impulses);
    free(reference->sums);
    free(reference->sums_before);
    free(reference->direction);
    free(reference->rounds);
    free(reference->taken);
    *reference = (Reference){0};
}

bool reference_reserve(Reference *r, const ContactProblem *problem) {
    size_t bodies = (size_t)problem->body_count + 1, contacts = (size_t)problem->contact_count + 1;
    ReferenceVelocity **of_bodies[] = {&r->velocities, &r->momenta, &r->momenta_before, &r->momenta_direction};
    ReferenceImpulse **of_contacts[] = {&r->impulses, &r->sums, &r->sums_before, &r->direction};
    for (int i = 0; i < 4; i++)
        if (!array_reserve((void **)of_bodies[i], &r->body_capacity[i], bodies, sizeof **of_bodies[i]) ||
            !array_reserve((void **)of_contacts[i], &r->contact_capacity[i], contacts, sizeof **of_contacts[i]))
            return false;
    return array_reserve((void **)&r->contacts, &r->contact_capacity[4], contacts, sizeof *r->contacts) &&
           array_reserve((void **)&r->rounds, &r->contact_capacity[5], contacts, sizeof *r->rounds) &&
           array_reserve((void **)&r->taken, &r->body_capacity[4], bodies, sizeof *r->taken);
}

/* Half a row: what an impulse along x, y does to one body; a velocity that no impulse changes goes to the target. */
static void load_half(ReferenceRow *row, double half[3], const ProblemBody *body, Vec2 arm, double x, double y) {
    const double inverse[] = {(double)body->inv_mass, (double)body->inv_mass, (double)body->inv_inertia};
    const double velocity[] = {(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity};
    const double along[] = {x, y, (double)arm.x * y - (double)arm.y * x};
    for (int i = 0; i < 3; i++) {
        if (inverse[i] == 0) row->target -= row->scale * along[i] * velocity[i];
        half[i] = row->scale * sqrt(inverse[i]) * along[i];
    }
}

static void add_impulse(ReferenceVelocity *velocity, const ProblemBody *body, Vec2 arm, double x, double y) {
    velocity->x += (double)body->inv_mass * x;
    velocity->y += (double)body->inv_mass * y;
    velocity->spin += (double)body->inv_inertia * ((double)arm.x * y - (double)arm.y * x);
}

static ReferenceRow load_row(const ContactProblem *problem, const ContactPoint *contact, double x, double y,
                             double mass, double target) {
    ReferenceRow row = {.scale = sqrt(mass)};
    row.target = row.scale * target;
    load_half(&row, row.a, &problem->bodies[contact->a], contact->arm_a, -x, -y);
    load_half(&row, row.b, &problem->bodies[contact->b], contact->arm_b, x, y);
    return row;
}

static void load_contact(ReferenceContact *out, const ContactProblem *problem, int index) {
    const ContactPoint *contact = &problem->contacts[index];
    double x = (double)contact->normal.x, y = (double)contact->normal.y;
    out->index = index;
    out->a = contact->a;
    out->b = contact->b;
    out->normal = load_row(problem, contact, x, y, (double)contact->mass_normal, (double)contact->bias);
    out->tangent = load_row(problem, contact, y, -x, (double)contact->mass_tangent, 0);
    out->friction = (double)contact->friction * out->normal.scale / out->tangent.scale;
}

static bool moves(const ProblemBody *body) { return body->inv_mass != 0.0f || body->inv_inertia != 0.0f; }

/* The first round in which neither moving body is taken yet; the last round takes all that are left over. */
static int find_round(Reference *r, const ContactProblem *problem, const ContactPoint *contact) {
    uint64_t none = 0, *taken_a = moves(&problem->bodies[contact->a]) ? &r->taken[contact->a] : &none;
    uint64_t also_none = 0, *taken_b = moves(&problem->bodies[contact->b]) ? &r->taken[contact->b] : &also_none;
    int round = 0;
    while (round < ROUNDS - 1 && ((*taken_a | *taken_b) >> round & 1) != 0) round++;
    *taken_a |= (uint64_t)1 << round;
    *taken_b |= (uint64_t)1 << round;
    return round;
}

static bool same_pair(const ContactPoint *x, const ContactPoint *y) { return x->a == y->a && x->b == y->b; }

/* In rounds of pairs that share no moving body: visits that do not wait for each other are done by the processor at
   the same time. */
void reference_load(Reference *r, const ContactProblem *problem) {
    r->body_count = problem->body_count;
    r->contact_count = problem->contact_count;
    memset(r->taken, 0, (size_t)problem->body_count * sizeof *r->taken);
    int last_round = 0, loaded = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        bool again = i > 0 && same_pair(contact, contact - 1);
        r->rounds[i] = again ? r->rounds[i - 1] : find_round(r, problem, contact);
        if (r->rounds[i] > last_round) last_round = r->rounds[i];
    }
    for (int round = 0; round <= last_round; round++)
        for (int i = 0; i < problem->contact_count; i++)
            if (r->rounds[i] == round) load_contact(&r->contacts[loaded++], problem, i);
}

/* The velocities that impulses give, in the problem's units and order. */
static void apply_impulses(Reference *r, const ContactProblem *problem) {
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        r->velocities[i] =
            (ReferenceVelocity){(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity};
    }
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        double normal = r->impulses[i].normal, tangent = r->impulses[i].tangent;
        double x = (double)contact->normal.x * normal + (double)contact->normal.y * tangent;
        double y = (double)contact->normal.y * normal - (double)contact->normal.x * tangent;
        add_impulse(&r->velocities[contact->a], &problem->bodies[contact->a], contact->arm_a, -x, -y);
        add_impulse(&r->velocities[contact->b], &problem->bodies[contact->b], contact->arm_b, x, y);
    }
}

static double scaled(double velocity, float inverse) { return inverse != 0.0f ? velocity / sqrt((double)inverse) : 0; }

void reference_start(Reference *r, const ContactProblem *problem, const ContactImpulse *start) {
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        ContactImpulse impulse =
            start != NULL ? start[i] : (ContactImpulse){contact->warm_normal, contact->warm_tangent};
        r->impulses[i] = (ReferenceImpulse){(double)impulse.normal, (double)impulse.tangent};
    }
    apply_impulses(r, problem);
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const ReferenceVelocity *velocity = &r->velocities[i];
        r->momenta[i] = (ReferenceVelocity){scaled(velocity->x, body->inv_mass), scaled(velocity->y, body->inv_mass),
                                            scaled(velocity->spin, body->inv_inertia)};
    }
    for (int i = 0; i < r->contact_count; i++) {
        const ReferenceContact *contact = &r->contacts[i];
        const ReferenceImpulse *impulse = &r->impulses[contact->index];
        r->sums[i] =
            (ReferenceImpulse){impulse->normal / contact->normal.scale, impulse->tangent / contact->tangent.scale};
    }
    r->sweeps = 0;
}

void reference_hand_out(Reference *r, const ContactProblem *problem) {
    for (int i = 0; i < r->contact_count; i++) {
        const ReferenceContact *contact = &r->contacts[i];
        r->impulses[contact->index] =
            (ReferenceImpulse){r->sums[i].normal * contact->normal.scale, r->sums[i].tangent * contact->tangent.scale};
    }
    apply_impulses(r, problem);
}
