/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The residual of the impulses in a set of sweeps. */
#include "engine/engine.h"
#include "methods/residual.h"
#include "methods/sweeps.h"

#include <math.h>

/* m/s: of a contact point of body b relative to that of body a. */
static Vec2 relative_velocity(Vec2 of_b, float spin_b, Vec2 arm_b, Vec2 of_a, float spin_a, Vec2 arm_a) {
    return vec2_sub(vec2_add(of_b, scalar_cross_vec2(spin_b, arm_b)), vec2_add(of_a, scalar_cross_vec2(spin_a, arm_a)));
}

/* (m/s)^2. normal: the accumulated impulse. Branchless: these branches mispredict. */
static float squared_residual(float bias, float normal_velocity, float normal) {
    const float missing = bias - normal_velocity;
    const float closing = missing > 0 ? missing : 0;
    const float residual = normal > 0 ? missing : closing;
    return residual * residual;
}

/* Of point k of a pair, whose bodies move relative to each other at this velocity there. */
static float squared_of_point(const SweepPair *pair, int k, Vec2 velocity) {
    return squared_residual(pair->points[k].bias, vec2_dot(velocity, pair->normal), pair->sums[k].normal);
}

/* (m/s)^2: of the changes that a visit would make; NaN if a velocity is NaN or infinite. */
static float squared_of_visit(const SweepPair *pair, int k, Vec2 velocity) {
    const SweepPoint *point = &pair->points[k];
    const ContactImpulse sum = pair->sums[k];
    const float slip = vec2_dot(velocity, vec2_cross_scalar(pair->normal, 1.0f));
    const float gap = vec2_dot(velocity, pair->normal) - point->bias, held = sum.normal / point->mass_normal;
    const float normal = gap >= held ? held : gap;
    const float limit = pair->friction * sum.normal;
    const float wanted = contact_clamp(sum.tangent - point->mass_tangent * slip, -limit, limit);
    const float tangent = (sum.tangent - wanted) / point->mass_tangent;
    const float if_finite = (velocity.x - velocity.x) + (velocity.y - velocity.y);
    return normal * normal + tangent * tangent + if_finite;
}

static inline Vec2 velocity_at(const SweepPair *pair, int k, const SweepBody *a, const SweepBody *b) {
    const SweepPoint *point = &pair->points[k];
    return relative_velocity(vec2(b->x, b->y), b->spin, point->arm_b, vec2(a->x, a->y), a->spin, point->arm_a);
}

/* The second point is computed whether it is there or not: a branch would mispredict. */
bool residual_reaches(const Sweeps *sweeps, int contact_count, float limit) {
    const float enough = limit * limit * (float)contact_count;
    float sum = 0;
    for (int i = 0; i < sweeps->pair_count; i++) {
        const SweepPair *pair = &sweeps->pairs[i];
        const SweepBody *a = &sweeps->bodies[sweep_body_at(sweeps->ends[i].a)];
        const SweepBody *b = &sweeps->bodies[sweep_body_at(sweeps->ends[i].b)];
        const float first = squared_of_point(pair, 0, velocity_at(pair, 0, a, b)),
                    second = squared_of_point(pair, 1, velocity_at(pair, 1, a, b));
        sum += first;
        sum += sweep_pair_points(pair) == 2 ? second : 0;
        if (sum >= enough) return true;
    }
    return false;
}

float residual_of_pair(const Sweeps *sweeps, int i) {
    const SweepPair *pair = &sweeps->pairs[i];
    const SweepBody *a = &sweeps->bodies[sweep_body_at(sweeps->ends[i].a)];
    const SweepBody *b = &sweeps->bodies[sweep_body_at(sweeps->ends[i].b)];
    float sum = 0;
    for (int k = 0; k < sweep_pair_points(pair); k++) sum += squared_of_visit(pair, k, velocity_at(pair, k, a, b));
    return sum;
}

void residual_of_pairs(const Sweeps *sweeps, float *squared) {
    if (sweeps->kernel == SWEEP_LANES)
        sweeps_residuals_in_lanes(sweeps, squared);
    else
        for (int i = 0; i < sweeps->pair_count; i++) squared[i] = residual_of_pair(sweeps, i);
}

static float overshoot_of_point(const SweepPair *pair, int k, Vec2 velocity) {
    const SweepPoint *point = &pair->points[k];
    const ContactImpulse sum = pair->sums[k];
    const Vec2 n = pair->normal, t = vec2_cross_scalar(n, 1.0f);
    const float gap = vec2_dot(velocity, n) - point->bias, slip = vec2_dot(velocity, t);
    const float turn_a = vec2_cross(point->arm_a, n) * vec2_cross(point->arm_a, t),
                turn_b = vec2_cross(point->arm_b, n) * vec2_cross(point->arm_b, t);
    const float knt = pair->inv_inertia_a * turn_a + pair->points[0].extra * turn_b;
    const float share = pair->friction * (point->mass_normal * knt);
    const bool held = sum.normal > 0;
    const float slides = held ? pair->friction * sum.normal - SWEEP_AT_LIMIT * fabsf(sum.tangent) : gap;
    const float against = held ? sum.tangent : -slip;
    const float overshoot = against < 0 ? -share : share;
    return slides < 0 && overshoot > 0 ? overshoot : 0;
}

void overshoot_of_pairs(const Sweeps *sweeps, float *overshoot) {
    if (sweeps->kernel == SWEEP_LANES) {
        sweeps_overshoots_in_lanes(sweeps, overshoot);
        return;
    }
    for (int i = 0; i < sweeps->pair_count; i++) {
        const SweepPair *pair = &sweeps->pairs[i];
        const SweepBody *a = &sweeps->bodies[sweep_body_at(sweeps->ends[i].a)];
        const SweepBody *b = &sweeps->bodies[sweep_body_at(sweeps->ends[i].b)];
        overshoot[i] = 0;
        for (int k = 0; k < sweep_pair_points(pair) && sweep_pair_may_overshoot(pair); k++) {
            const float of_point = overshoot_of_point(pair, k, velocity_at(pair, k, a, b));
            if (of_point > overshoot[i]) overshoot[i] = of_point;
        }
    }
}

bool residual_reaches_scalar(const ContactProblem *problem, const ContactSolution *solution, float limit) {
    const float enough = limit * limit * (float)problem->contact_count;
    float sum = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const BodyVelocity *a = &solution->velocities[contact->a], *b = &solution->velocities[contact->b];
        const Vec2 velocity =
            relative_velocity(b->linear, b->angular, contact->arm_b, a->linear, a->angular, contact->arm_a);
        sum += squared_residual(contact->bias, vec2_dot(velocity, contact->normal), solution->impulses[i].normal);
    }
    return problem->contact_count > 0 && sum >= enough;
}

float residual_of_motion(const ContactProblem *problem, int i) {
    const ContactPoint *contact = &problem->contacts[i];
    const ProblemBody *a = &problem->bodies[contact->a], *b = &problem->bodies[contact->b];
    const Vec2 velocity = relative_velocity(b->velocity, b->angular_velocity, contact->arm_b, a->velocity,
                                            a->angular_velocity, contact->arm_a);
    return vec2_dot(velocity, velocity);
}
