/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Islands by union-find over the contacts (methods/islands.h). */
#include "methods/islands.h"
#include "methods/impulses.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void islands_free(Islands *islands) {
    free(islands->by_body.memory);
    free(islands->by_contact.memory);
    *islands = (Islands){0};
}

/* What an answer does in an island. */
struct Gain {
    double before, across, square; /* J: m v v, m v dv and m dv dv, of velocities v before and changes dv */
    double mass;                   /* kg, of bodies that move */
    float missed, bias; /* m/s: the largest change of a contact's velocity by one more visit; the largest bias */
    double biases;      /* m/s: the sum of biases */
    float share;
};

/* An island has at most one body that does not move for each contact. */
static bool islands_reserve(Islands *s, const ContactProblem *problem) {
    const size_t bodies = (size_t)problem->body_count, contacts = (size_t)problem->contact_count,
                 all = bodies + contacts;
    return ARRAY_BLOCK_RESERVE(&s->by_body, ARRAY_PART(s->islands, bodies), ARRAY_PART(s->gains, bodies),
                               ARRAY_PART(s->parent, bodies), ARRAY_PART(s->grounded, bodies),
                               ARRAY_PART(s->number, bodies), ARRAY_PART(s->members, bodies),
                               ARRAY_PART(s->behind_members, bodies), ARRAY_PART(s->behind_contacts, bodies),
                               ARRAY_PART(s->place, bodies), ARRAY_PART(s->in_island, bodies)) &&
           ARRAY_BLOCK_RESERVE(&s->by_contact, ARRAY_PART(s->island, contacts), ARRAY_PART(s->contacts, contacts),
                               ARRAY_PART(s->bodies, all), ARRAY_PART(s->body_copies, all),
                               ARRAY_PART(s->contact_copies, contacts), ARRAY_PART(s->velocities, all),
                               ARRAY_PART(s->impulses, contacts));
}

static bool is_new_pair(const ContactProblem *problem, int i) {
    const ContactPoint *contact = &problem->contacts[i];
    return i == 0 || contact[-1].a != contact->a || contact[-1].b != contact->b;
}

static void islands_connect(Islands *s, const ContactProblem *problem) {
    int32_t *parent = s->parent;
    s->moving = 0;
    for (int i = 0; i < problem->body_count; i++) {
        parent[i] = problem_body_moves(&problem->bodies[i]) ? i : -1;
        s->moving += parent[i] >= 0;
        s->number[i] = -1;
        s->grounded[i] = false;
    }
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        s->grounded[contact->a] |= parent[contact->b] < 0;
        s->grounded[contact->b] |= parent[contact->a] < 0;
        if (!is_new_pair(problem, i) || parent[contact->a] < 0 || parent[contact->b] < 0) continue;
        const int32_t a = islands_root(parent, contact->a), b = islands_root(parent, contact->b);
        parent[b] = a;
    }
}

/* Of the pair that contact i begins. An island's bodies less one are as many pairs as a tree has; each further pair
   closes a loop, and so does each further body on the ground. */
static int32_t count_pair(Islands *s, const ContactProblem *problem, int i) {
    const ContactPoint *contact = &problem->contacts[i];
    const bool a = s->parent[contact->a] >= 0, b = s->parent[contact->b] >= 0;
    if (!a && !b) return -1;
    int32_t *number = &s->number[islands_root(s->parent, a ? contact->a : contact->b)];
    if (*number < 0) {
        s->islands[s->count] = (Island){.loops = 1};
        *number = s->count++;
    }
    s->islands[*number].loops += a && b;
    return *number;
}

static int32_t island_of_body(Islands *s, int body) {
    return s->parent[body] < 0 ? -1 : s->number[islands_root(s->parent, body)];
}

bool islands_find(Islands *s, const ContactProblem *problem) {
    if (!islands_reserve(s, problem)) return false;
    islands_connect(s, problem);
    s->count = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        s->island[i] = is_new_pair(problem, i) ? count_pair(s, problem, i) : s->island[i - 1];
        if (s->island[i] >= 0) s->islands[s->island[i]].contacts++;
    }
    for (int i = 0; i < problem->body_count; i++) {
        const int32_t k = island_of_body(s, i);
        if (k < 0) continue;
        s->islands[k].bodies++;
        s->islands[k].loops--;
        if (s->grounded[i] && s->islands[k].grounded++ > 0) s->islands[k].loops++;
    }
    s->sorted = false;
    return true;
}

static void islands_sort(Islands *s, const ContactProblem *problem) {
    int32_t members = 0, contacts = 0;
    for (int k = 0; k < s->count; k++) {
        s->behind_members[k] = members, s->behind_contacts[k] = contacts;
        members += s->islands[k].bodies, contacts += s->islands[k].contacts;
    }
    for (int i = 0; i < problem->body_count; i++) {
        const int32_t k = island_of_body(s, i);
        if (k >= 0) s->members[s->behind_members[k]++] = i;
    }
    for (int i = 0; i < problem->contact_count; i++)
        if (s->island[i] >= 0) s->contacts[s->behind_contacts[s->island[i]]++] = i;
    memset(s->in_island, -1, (size_t)problem->body_count * sizeof *s->in_island);
    s->sorted = true;
}

/* Collects the bodies that do not move and touch the island, in order, behind its others. Returns their number. */
static int find_fixed(Islands *s, const ContactProblem *problem, int k, const int32_t *contacts) {
    int32_t *fixed = &s->bodies[s->islands[k].bodies];
    int count = 0;
    for (int i = 0; i < s->islands[k].contacts; i++) {
        const ContactPoint *contact = &problem->contacts[contacts[i]];
        const int32_t body = s->parent[contact->a] < 0 ? contact->a : contact->b;
        if (s->parent[body] >= 0 || s->in_island[body] == k) continue;
        s->in_island[body] = k;
        int at = count++; /* mostly the last */
        for (; at > 0 && fixed[at - 1] > body; at--) fixed[at] = fixed[at - 1];
        fixed[at] = body;
    }
    return count;
}

ContactProblem islands_take(Islands *s, const ContactProblem *problem, int k, ContactSolution *room) {
    if (!s->sorted) islands_sort(s, problem);
    const Island *island = &s->islands[k];
    const int32_t *members = &s->members[s->behind_members[k] - island->bodies];
    const int32_t *contacts = &s->contacts[s->behind_contacts[k] - island->contacts];
    const int fixed = find_fixed(s, problem, k, contacts);
    /* Members, and those that do not move, which are behind their place, in order. */
    const int32_t *still = &s->bodies[island->bodies];
    for (int i = 0, f = 0, at = 0; at < island->bodies + fixed; at++)
        s->bodies[at] = f < fixed && (i == island->bodies || still[f] < members[i]) ? still[f++] : members[i++];
    ContactProblem part = {.body_count = island->bodies + fixed,
                           .contact_count = island->contacts,
                           .bomb = -1,
                           .dt = problem->dt,
                           .fall = problem->fall,
                           .bodies = s->body_copies,
                           .contacts = s->contact_copies};
    for (int i = 0; i < part.body_count; i++) {
        s->place[s->bodies[i]] = i;
        s->body_copies[i] = problem->bodies[s->bodies[i]];
        if (s->bodies[i] == problem->bomb) part.bomb = i;
    }
    for (int i = 0; i < island->contacts; i++) {
        ContactPoint *contact = &s->contact_copies[i];
        *contact = problem->contacts[contacts[i]];
        contact->a = s->place[contact->a], contact->b = s->place[contact->b];
    }
    *room = (ContactSolution){.velocities = s->velocities, .impulses = s->impulses};
    return part;
}

void islands_put(const Islands *s, int k, const ContactProblem *part, const ContactSolution *of_part,
                 ContactSolution *solution) {
    const int32_t *contacts = &s->contacts[s->behind_contacts[k] - part->contact_count];
    for (int i = 0; i < part->body_count; i++)
        if (s->parent[s->bodies[i]] >= 0) solution->velocities[s->bodies[i]] = of_part->velocities[i];
    for (int i = 0; i < part->contact_count; i++) solution->impulses[contacts[i]] = of_part->impulses[i];
    fallbacks_add(&solution->fallbacks, &of_part->fallbacks);
}

/* Energy that the answer gives to a body is across + square / 2. */
static void add_body(struct Gain *gain, const ProblemBody *body, const BodyVelocity *after) {
    const double x = (double)body->velocity.x, y = (double)body->velocity.y, spin = (double)body->angular_velocity;
    const double dx = (double)after->linear.x - x, dy = (double)after->linear.y - y,
                 turn = (double)after->angular - spin;
    const double mass = body->inv_mass > 0 ? 1 / (double)body->inv_mass : 0,
                 inertia = body->inv_inertia > 0 ? 1 / (double)body->inv_inertia : 0;
    gain->before += mass * (x * x + y * y) + inertia * (spin * spin);
    gain->across += mass * (x * dx + y * dy) + inertia * (spin * turn);
    gain->square += mass * (dx * dx + dy * dy) + inertia * (turn * turn);
    gain->mass += mass;
}

/* By more than velocities round to. */
static bool gains(const struct Gain *gain) {
    return 2 * gain->across + gain->square > 0x1p-21 * (gain->before + gain->square);
}

static void add_contact(struct Gain *gain, const ContactPoint *contact, const ContactSolution *solution,
                        ContactImpulse impulse) {
    const BodyVelocity *a = &solution->velocities[contact->a], *b = &solution->velocities[contact->b];
    const Vec2 velocity = vec2_sub(vec2_add(b->linear, scalar_cross_vec2(b->angular, contact->arm_b)),
                                   vec2_add(a->linear, scalar_cross_vec2(a->angular, contact->arm_a)));
    const float slip = vec2_dot(velocity, vec2_cross_scalar(contact->normal, 1.0f));
    const float limit = contact->friction * impulse.normal;
    const float held = contact_clamp(impulse.tangent - contact->mass_tangent * slip, -limit, limit);
    const float normal =
        fminf(vec2_dot(velocity, contact->normal) - contact->bias, impulse.normal / contact->mass_normal);
    gain->missed = fmaxf(gain->missed, fmaxf(fabsf(normal), fabsf(held - impulse.tangent) / contact->mass_tangent));
    gain->bias = fmaxf(gain->bias, contact->bias);
    gain->biases += fmax((double)contact->bias, 0);
}

bool islands_take_gain(Islands *s, const ContactProblem *problem, ContactSolution *solution) {
    bool any = false;
    s->shortened = false;
    for (int i = 0; i < problem->body_count && !any; i++) {
        struct Gain alone = {0};
        add_body(&alone, &problem->bodies[i], &solution->velocities[i]);
        any = gains(&alone);
    }
    if (!any) return true;
    if (!islands_find(s, problem)) return false;
    for (int k = 0; k < s->count; k++) s->gains[k] = (struct Gain){.share = 1};
    for (int i = 0; i < problem->body_count; i++) {
        const int32_t k = island_of_body(s, i);
        if (k >= 0) add_body(&s->gains[k], &problem->bodies[i], &solution->velocities[i]);
    }
    for (int i = 0; i < problem->contact_count; i++)
        if (s->island[i] >= 0 && gains(&s->gains[s->island[i]]))
            add_contact(&s->gains[s->island[i]], &problem->contacts[i], solution, solution->impulses[i]);
    for (int k = 0; k < s->count; k++) {
        struct Gain *gain = &s->gains[k];
        if (!gains(gain)) continue;
        const double least = gain->across < 0 ? -gain->across / gain->square : 0;
        const double may = gain->missed > gain->bias ? 0 : 0.5 * gain->mass * gain->biases * gain->biases;
        gain->share = (float)fmin(least + sqrt(2 * may / gain->square), 1);
        s->shortened |= gain->share < 1;
    }
    for (int i = 0; i < problem->body_count; i++) {
        const int32_t k = island_of_body(s, i);
        if (k < 0 || s->gains[k].share == 1) continue;
        const float share = s->gains[k].share;
        const ProblemBody *body = &problem->bodies[i];
        BodyVelocity *v = &solution->velocities[i];
        v->linear = vec2_add(body->velocity, vec2_scale(share, vec2_sub(v->linear, body->velocity)));
        v->angular = body->angular_velocity + share * (v->angular - body->angular_velocity);
    }
    for (int i = 0; i < problem->contact_count; i++) {
        if (s->island[i] < 0 || s->gains[s->island[i]].share == 1) continue;
        const float share = s->gains[s->island[i]].share, normal = share * solution->impulses[i].normal;
        const float tangent = share * solution->impulses[i].tangent, limit = problem->contacts[i].friction * normal;
        solution->impulses[i] = (ContactImpulse){0, 0}; /* unless they are finite; rounded into the cone */
        if (isfinite(normal) && isfinite(tangent))
            solution->impulses[i] = (ContactImpulse){normal, contact_clamp(tangent, -limit, limit)};
    }
    return true;
}
