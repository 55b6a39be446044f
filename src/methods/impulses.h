/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Impulses at contacts, one after the other: what a contact solver needs, and sequential impulses as a plain text.

       sequential_impulses_begin(problem, &options, solution); // velocities after gravity and warm start
       for (int i = 0; i < problem->contact_count; i++) {
           const ContactPoint *contact = &problem->contacts[i];
           const Vec2 velocity = contact_relative_velocity(&solution->velocities[contact->a],
                                                           &solution->velocities[contact->b], contact);
           contact_push(solution->velocities, contact, problem->bodies, (ContactImpulse){normal, tangent});
           ...
*/
#pragma once
#include "engine/engine.h"

#include <stdbool.h>
#include <string.h>

enum { SWEEPS_MAX = 1000000 }; /* of one step, for any method */

/* Impulses and relative velocities at contacts, for the scalar reference implementations. The order of all float
   operations is part of the engine's result. */

/* True if both contacts are of the same bodies and normal. */
static inline bool contact_shares_surface(const ContactPoint *first, const ContactPoint *second) {
    return first->a == second->a && first->b == second->b &&
           memcmp(&first->normal, &second->normal, sizeof first->normal) == 0 &&
           memcmp(&first->friction, &second->friction, sizeof first->friction) == 0;
}

/* The number of contacts (1 or 2) of the pair and normal that begin at contact `first`. */
static inline int contact_surface_points(const ContactProblem *problem, int first) {
    const ContactPoint *contact = &problem->contacts[first];
    return first + 1 < problem->contact_count && contact_shares_surface(contact, contact + 1) ? 2 : 1;
}

/* Applies impulse to b and its opposite to a. */
static inline void contact_apply(BodyVelocity *a, BodyVelocity *b, const ContactPoint *contact,
                                 const ProblemBody *bodies, Vec2 impulse) {
    const ProblemBody *body_a = &bodies[contact->a], *body_b = &bodies[contact->b];
    a->linear = vec2_sub(a->linear, vec2_scale(body_a->inv_mass, impulse));
    a->angular -= body_a->inv_inertia * vec2_cross(contact->arm_a, impulse);
    b->linear = vec2_add(b->linear, vec2_scale(body_b->inv_mass, impulse));
    b->angular += body_b->inv_inertia * vec2_cross(contact->arm_b, impulse);
}

/* The same for an impulse along normal and tangent. */
static inline void contact_push(BodyVelocity *velocities, const ContactPoint *contact, const ProblemBody *bodies,
                                ContactImpulse push) {
    Vec2 tangent = vec2_cross_scalar(contact->normal, 1.0f);
    Vec2 impulse = vec2_add(vec2_scale(push.normal, contact->normal), vec2_scale(push.tangent, tangent));
    contact_apply(&velocities[contact->a], &velocities[contact->b], contact, bodies, impulse);
}

/* Velocity of b's point relative to a's. */
static inline Vec2 contact_relative_velocity(const BodyVelocity *a, const BodyVelocity *b,
                                             const ContactPoint *contact) {
    Vec2 of_b = vec2_add(b->linear, scalar_cross_vec2(b->angular, contact->arm_b));
    return vec2_sub(vec2_sub(of_b, a->linear), scalar_cross_vec2(a->angular, contact->arm_a));
}

static inline float contact_clamp(float value, float low, float high) {
    float capped = value < high ? value : high;
    return low > capped ? low : capped;
}

/* The scalar reference implementation of sequential impulses. The sweeps of methods/sweeps.h have its bits. */

typedef struct SequentialOptions {
    bool accumulate; /* clamp accumulated impulses, not each impulse */
    bool warm;       /* start from the problem's warm-start impulses, not from zero */
} SequentialOptions;

/* Sets velocities and impulses before the first sweep. */
void sequential_impulses_begin(const ContactProblem *problem, const SequentialOptions *options,
                               ContactSolution *solution);

/* Visits `count` contacts, from `first` on. */
void sequential_impulses_visit(const ContactProblem *problem, const SequentialOptions *options, int first, int count,
                               ContactSolution *solution);

/* One sweep. */
void sequential_impulses_sweep(const ContactProblem *problem, const SequentialOptions *options,
                               ContactSolution *solution);

/* Begins, then `count` sweeps. */
void sequential_impulses_solve(const ContactProblem *problem, const SequentialOptions *options, int count,
                               ContactSolution *solution);
