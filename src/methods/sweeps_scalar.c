/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps over the packed records, pair by pair: for few contacts, and for every processor. */
#include "engine/engine.h"
#include "methods/sweeps.h"

#include <string.h>

static Vec2 relative_velocity(const SweepBody *a, const SweepBody *b, const SweepPoint *point) {
    return vec2(((b->x - b->spin * point->arm_b.y) - a->x) + a->spin * point->arm_a.y,
                ((b->y + b->spin * point->arm_b.x) - a->y) - a->spin * point->arm_a.x);
}

static void sweeps_scalar_apply(SweepBody *a, SweepBody *b, const SweepPair *pair, const SweepPoint *point,
                                Vec2 impulse) {
    a->x -= a->inv_mass * impulse.x;
    a->y -= a->inv_mass * impulse.y;
    a->spin -= pair->inv_inertia_a * vec2_cross(point->arm_a, impulse);
    b->x += b->inv_mass * impulse.x;
    b->y += b->inv_mass * impulse.y;
    b->spin += pair->points[0].extra * vec2_cross(point->arm_b, impulse);
}

static void push_point(SweepBody *a, SweepBody *b, const SweepPair *pair, int k, ContactImpulse by) {
    Vec2 along_tangent = vec2_scale(by.tangent, vec2_cross_scalar(pair->normal, 1.0f));
    Vec2 impulse = vec2_add(vec2_scale(by.normal, pair->normal), along_tangent);
    sweeps_scalar_apply(a, b, pair, &pair->points[k], impulse);
}

static void push_pair(Sweeps *sweeps, int i, const ContactImpulse impulses[2]) {
    const SweepPair *pair = &sweeps->pairs[i];
    SweepEnds ends = sweeps->ends[i];
    SweepBody a = sweeps->bodies[sweep_body_at(ends.a)], b = sweeps->bodies[sweep_body_at(ends.b)];
    for (int k = 0; k < sweep_pair_points(pair); k++) push_point(&a, &b, pair, k, impulses[k]);
    if (ends.a >= 0) sweeps->bodies[ends.a] = a;
    if (ends.b >= 0) sweeps->bodies[ends.b] = b;
}

void sweeps_push_sums(Sweeps *sweeps, const bool *chosen) {
    for (int i = 0; i < sweeps->pair_count; i++)
        if (chosen == NULL || chosen[sweeps->group[i]]) push_pair(sweeps, i, sweeps->pairs[i].sums);
}

void sweeps_push(Sweeps *sweeps, const ContactImpulse *impulses) {
    for (int i = 0; i < sweeps->pair_count; i++) {
        SweepPair *pair = &sweeps->pairs[i];
        const ContactImpulse *by = &impulses[sweeps->first[i]];
        push_pair(sweeps, i, by);
        for (int k = 0; k < sweep_pair_points(pair); k++) {
            pair->sums[k].normal += by[k].normal;
            pair->sums[k].tangent += by[k].tangent;
        }
    }
}

static void solve_point(SweepBody *a, SweepBody *b, const SweepPair *pair, const SweepPoint *point,
                        ContactImpulse *sum) {
    float normal_velocity = vec2_dot(relative_velocity(a, b, point), pair->normal);
    float total = sum->normal + point->mass_normal * (point->bias - normal_velocity);
    total = total > 0.0f ? total : 0.0f;
    float normal = total - sum->normal;
    sum->normal = total;
    sweeps_scalar_apply(a, b, pair, point, vec2_scale(normal, pair->normal));

    Vec2 direction = vec2_cross_scalar(pair->normal, 1.0f);
    float tangent_velocity = vec2_dot(relative_velocity(a, b, point), direction);
    float limit = pair->friction * sum->normal;
    total = sum->tangent - point->mass_tangent * tangent_velocity;
    total = total < limit ? total : limit;
    total = -limit > total ? -limit : total;
    float tangent = total - sum->tangent;
    sum->tangent = total;
    sweeps_scalar_apply(a, b, pair, point, vec2_scale(tangent, direction));
}

/* Not 0 if the bits differ; those of 0 and -0 do. */
static uint32_t sweeps_scalar_difference(float x, float y) {
    uint32_t bits_x, bits_y;
    memcpy(&bits_x, &x, sizeof x);
    memcpy(&bits_y, &y, sizeof y);
    return bits_x ^ bits_y;
}

/* Stores a body's velocity; returns not 0 if it has changed. By components, because the next visit reads components. */
static uint32_t put_back(SweepBody *body, const SweepBody *after) {
    uint32_t changed = sweeps_scalar_difference(body->x, after->x) | sweeps_scalar_difference(body->y, after->y) |
                       sweeps_scalar_difference(body->spin, after->spin);
    body->x = after->x;
    body->y = after->y;
    body->spin = after->spin;
    return changed;
}

static uint32_t put_back_sum(ContactImpulse *sum, ContactImpulse after) {
    uint32_t changed =
        sweeps_scalar_difference(sum->normal, after.normal) | sweeps_scalar_difference(sum->tangent, after.tangent);
    sum->normal = after.normal;
    sum->tangent = after.tangent;
    return changed;
}

/* Not 0 if the visit changed anything. */
static inline uint32_t sweeps_scalar_visit(SweepBody *bodies, const SweepPair *pair, ContactImpulse *sums,
                                           SweepEnds ends) {
    SweepBody *body_a = &bodies[sweep_body_at(ends.a)], *body_b = &bodies[sweep_body_at(ends.b)];
    SweepBody a = *body_a, b = *body_b;
    uint32_t changed = 0;
    int points = pair->points[1].extra < 0.0f ? 2 : 1;
    for (int k = 0; k < points; k++) {
        ContactImpulse sum = sums[k];
        solve_point(&a, &b, pair, &pair->points[k], &sum);
        changed |= put_back_sum(&sums[k], sum);
    }
    if (ends.a >= 0) changed |= put_back(body_a, &a);
    if (ends.b >= 0) changed |= put_back(body_b, &b);
    return changed;
}

/* True for a pair whose last visit changed nothing, if no visit has changed its bodies since: it is skipped. */
static bool may_rest(const Sweeps *sweeps, int pair) {
    int64_t quiet = sweeps->quiet_since[pair];
    SweepEnds ends = sweeps->ends[pair];
    return quiet > sweeps->changed_at[sweep_body_at(ends.a)] && quiet > sweeps->changed_at[sweep_body_at(ends.b)];
}

/* Records the changes by visit number `now`. */
static bool note_visit(Sweeps *sweeps, int pair, bool changed, int64_t now) {
    SweepEnds ends = sweeps->ends[pair];
    sweeps->quiet_since[pair] = changed ? 0 : now;
    if (changed && ends.a >= 0) sweeps->changed_at[ends.a] = now;
    if (changed && ends.b >= 0) sweeps->changed_at[ends.b] = now;
    return changed;
}

/* Extrapolates `now` by the change since `before`; returns not 0 if the result differs from `now`. */
static uint32_t sweeps_scalar_extrapolate(float *before, float now, float factor) {
    float next = now - (factor * (*before - now) + 0.0f);
    *before = next;
    return sweeps_scalar_difference(next, now);
}

/* Replaces `to`, the velocities of two sweeps ago, by those that the next sweep starts from. factors[groups] */
static bool extrapolate_bodies(Sweeps *sweeps, SweepBody *to, const SweepBody *from, const float *factors,
                               int64_t now) {
    bool any = false;
    for (int i = 0; i < sweeps->body_count; i++) {
        const float factor = factors[sweeps->group_of_body[i]];
        if (sweeps_scalar_extrapolate(&to[i].x, from[i].x, factor) |
            sweeps_scalar_extrapolate(&to[i].y, from[i].y, factor) |
            sweeps_scalar_extrapolate(&to[i].spin, from[i].spin, factor)) {
            sweeps->changed_at[i] = now;
            any = true;
        }
    }
    return any;
}

static uint32_t extrapolate_sums(ContactImpulse to[2], const ContactImpulse from[2], float factor) {
    uint32_t changed = 0;
    for (int k = 0; k < 2; k++)
        changed |= sweeps_scalar_extrapolate(&to[k].normal, from[k].normal, factor) |
                   sweeps_scalar_extrapolate(&to[k].tangent, from[k].tangent, factor);
    return changed;
}

/* One sweep in the current half of bodies and sums; the other half has the results of the previous sweep. True if it
   changed anything. */
static bool sweep_in_turn(Sweeps *sweeps, int half, const float *factors, int64_t *now) {
    SweepBody *halves[2] = {sweeps->bodies, sweeps->bodies + sweeps->body_count + 1};
    ContactImpulse *sums[2] = {sweeps->sums, sweeps->sums + 2 * (sweeps->pair_count + 1)};
    bool changed = extrapolate_bodies(sweeps, halves[half], halves[1 - half], factors, ++*now);
    for (int i = 0; i < sweeps->pair_count; i++) {
        if (may_rest(sweeps, i)) continue;
        uint32_t moved = extrapolate_sums(&sums[half][2 * i], &sums[1 - half][2 * i], factors[sweeps->group[i]]);
        moved |= sweeps_scalar_visit(halves[half], &sweeps->pairs[i], &sums[half][2 * i], sweeps->ends[i]);
        changed |= note_visit(sweeps, i, moved != 0, ++*now);
    }
    return changed;
}

static bool sweep_in_place(Sweeps *sweeps, int64_t *now) {
    bool changed = false;
    for (int i = 0; i < sweeps->pair_count; i++) {
        if (may_rest(sweeps, i)) continue;
        SweepPair *pair = &sweeps->pairs[i];
        changed |=
            note_visit(sweeps, i, sweeps_scalar_visit(sweeps->bodies, pair, pair->sums, sweeps->ends[i]) != 0, ++*now);
    }
    return changed;
}

void sweeps_run_one_by_one(Sweeps *sweeps, const float *factors, int count) {
    memset(sweeps->quiet_since, 0, (size_t)sweeps->pair_count * sizeof *sweeps->quiet_since);
    memset(sweeps->changed_at, 0, (size_t)sweeps->body_count * sizeof *sweeps->changed_at);
    bool changed = true;
    int64_t now = 0;
    for (int sweep = 0; changed && sweep < count; sweep++)
        changed = factors != NULL ? sweep_in_turn(sweeps, sweep % 2, factors + sweep * sweeps->groups, &now)
                                  : sweep_in_place(sweeps, &now);
}

/* Sequential impulses (projected Gauss-Seidel), as in Box2D-Lite.

   Each sweep visits every contact in turn: first the normal impulse that brings the normal velocity to its bias,
   clamped so that the accumulated impulse is not negative; then the tangent impulse that stops the sliding, clamped so
   that the accumulated impulse stays in the friction cone |Pt| <= mu Pn:

       Pn' = max(Pn + mass_n (bias - vn), 0),   Pt' = contact_clamp(Pt - mass_t vt, -mu Pn', mu Pn')

   Accumulated impulses start from the last step's (warm start). Source: Catto, "Iterative Dynamics with Temporal
   Coherence" (2005); "Fast and Simple Physics using Sequential Impulses" (GDC 2006). Fails by slow convergence: against
   the order of visits an impulse propagates by one contact per sweep, so high stacks and heavy boxes on light ones stay
   soft.

   Bit-exact: the order of all float operations is fixed. This is the scalar reference implementation; with accumulated
   impulses the engine runs sweeps.h, which has the same bits. */

static void warm_start(const ContactProblem *problem, bool warm, ContactSolution *solution) {
    static const ContactImpulse cold = {0, 0};
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        ContactImpulse start = warm ? (ContactImpulse){contact->warm_normal, contact->warm_tangent} : cold;
        solution->impulses[i] = start;
        contact_push(solution->velocities, contact, problem->bodies, start);
    }
}

/* One visit of a contact: the normal impulse, then friction. */
static void solve_contact(const ContactPoint *contact, const ProblemBody *bodies, BodyVelocity *velocities,
                          ContactImpulse *sum, const SequentialOptions *options) {
    const bool accumulate = options->accumulate;
    BodyVelocity *a = &velocities[contact->a], *b = &velocities[contact->b];

    float normal_velocity = vec2_dot(contact_relative_velocity(a, b, contact), contact->normal);
    float normal = contact->mass_normal * (-normal_velocity + contact->bias);
    float pushed = accumulate ? sum->normal : 0.0f;
    float total = pushed + normal > 0.0f ? pushed + normal : 0.0f;
    normal = total - pushed;
    sum->normal = accumulate ? total : sum->normal + normal;
    contact_apply(a, b, contact, bodies, vec2_scale(normal, contact->normal));

    Vec2 direction = vec2_cross_scalar(contact->normal, 1.0f);
    float tangent_velocity = vec2_dot(contact_relative_velocity(a, b, contact), direction);
    float tangent = contact->mass_tangent * -tangent_velocity;
    float limit = contact->friction * (accumulate ? sum->normal : normal);
    float dragged = accumulate ? sum->tangent : 0.0f;
    total = contact_clamp(dragged + tangent, -limit, limit);
    tangent = total - dragged;
    sum->tangent = accumulate ? total : sum->tangent + tangent;
    contact_apply(a, b, contact, bodies, vec2_scale(tangent, direction));
}

void sequential_impulses_begin(const ContactProblem *problem, const SequentialOptions *options,
                               ContactSolution *solution) {
    contact_solution_begin(problem, solution);
    if (options->accumulate) warm_start(problem, options->warm, solution);
}

void sequential_impulses_visit(const ContactProblem *problem, const SequentialOptions *options, int first, int count,
                               ContactSolution *solution) {
    for (int i = first; i < first + count; i++)
        solve_contact(&problem->contacts[i], problem->bodies, solution->velocities, &solution->impulses[i], options);
}

void sequential_impulses_sweep(const ContactProblem *problem, const SequentialOptions *options,
                               ContactSolution *solution) {
    sequential_impulses_visit(problem, options, 0, problem->contact_count, solution);
}

void sequential_impulses_solve(const ContactProblem *problem, const SequentialOptions *options, int count,
                               ContactSolution *solution) {
    sequential_impulses_begin(problem, options, solution);
    for (int sweep = 0; sweep < count; sweep++) sequential_impulses_sweep(problem, options, solution);
}
