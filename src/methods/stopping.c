/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/solvers.h"
#include "methods/sweeps.h"

static Vec2 point_velocity(Vec2 linear, float spin, Vec2 arm) { return vec2_add(linear, scalar_cross_vec2(spin, arm)); }

/* (m/s)^2. normal: the accumulated impulse. Branchless: these branches mispredict. */
static float squared_residual(float bias, float normal_velocity, float normal) {
    const float missing = bias - normal_velocity;
    const float closing = missing > 0 ? missing : 0;
    const float residual = normal > 0 ? missing : closing;
    return residual * residual;
}

/* m/s: of body b relative to body a. */
static Vec2 sweep_velocity(const SweepPoint *point, const SweepBody *a, const SweepBody *b) {
    return vec2_sub(point_velocity(vec2(b->x, b->y), b->spin, point->arm_b),
                    point_velocity(vec2(a->x, a->y), a->spin, point->arm_a));
}

static float squared_of_point(const SweepPair *pair, int k, const SweepBody *a, const SweepBody *b) {
    const SweepPoint *point = &pair->points[k];
    const Vec2 velocity = sweep_velocity(point, a, b);
    return squared_residual(point->bias, vec2_dot(velocity, pair->normal), pair->sums[k].normal);
}

bool residual_reaches(const Sweeps *sweeps, int contact_count, float limit) {
    const float enough = limit * limit * (float)contact_count;
    float sum = 0;
    for (int i = 0; i < sweeps->pair_count; i++) {
        const SweepPair *pair = &sweeps->pairs[i];
        const SweepBody *a = &sweeps->bodies[sweep_body_at(sweeps->ends[i].a)];
        const SweepBody *b = &sweeps->bodies[sweep_body_at(sweeps->ends[i].b)];
        const float first = squared_of_point(pair, 0, a, b), second = squared_of_point(pair, 1, a, b);
        sum += first;
        sum += sweep_pair_points(pair) == 2 ? second : 0;
        if (sum >= enough) return true;
    }
    return false;
}

bool residual_reaches_scalar(const ContactProblem *problem, const ContactSolution *solution, float limit) {
    const float enough = limit * limit * (float)problem->contact_count;
    float sum = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const BodyVelocity *a = &solution->velocities[contact->a], *b = &solution->velocities[contact->b];
        const Vec2 velocity = vec2_sub(point_velocity(b->linear, b->angular, contact->arm_b),
                                       point_velocity(a->linear, a->angular, contact->arm_a));
        sum += squared_residual(contact->bias, vec2_dot(velocity, contact->normal), solution->impulses[i].normal);
    }
    return problem->contact_count > 0 && sum >= enough;
}

/* (m/s)^2: of the changes that a visit would make. NaN remains. */
static float squared_of_visit(const SweepPair *pair, int k, const SweepBody *a, const SweepBody *b) {
    const SweepPoint *point = &pair->points[k];
    const ContactImpulse sum = pair->sums[k];
    const Vec2 velocity = sweep_velocity(point, a, b);
    const float slip = vec2_dot(velocity, vec2_cross_scalar(pair->normal, 1.0f));
    const float gap = vec2_dot(velocity, pair->normal) - point->bias, held = sum.normal / point->mass_normal;
    const float normal = gap >= held ? held : gap;
    const float limit = pair->friction * sum.normal;
    const float wanted = contact_clamp(sum.tangent - point->mass_tangent * slip, -limit, limit);
    const float tangent = (sum.tangent - wanted) / point->mass_tangent;
    return normal * normal + tangent * tangent;
}

bool residual_of_visits_reaches(const Sweeps *sweeps, int contact_count, float limit) {
    const float enough = limit * limit * (float)contact_count;
    float sum = 0;
    for (int i = 0; i < sweeps->pair_count; i++) {
        const SweepPair *pair = &sweeps->pairs[i];
        const SweepBody *a = &sweeps->bodies[sweep_body_at(sweeps->ends[i].a)];
        const SweepBody *b = &sweeps->bodies[sweep_body_at(sweeps->ends[i].b)];
        for (int k = 0; k < sweep_pair_points(pair); k++) sum += squared_of_visit(pair, k, a, b);
        if (!(sum < enough)) return true;
    }
    return false;
}

bool residual_motion_reaches(const ContactProblem *problem, float limit) {
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const ProblemBody *a = &problem->bodies[contact->a], *b = &problem->bodies[contact->b];
        const Vec2 velocity = vec2_sub(point_velocity(b->velocity, b->angular_velocity, contact->arm_b),
                                       point_velocity(a->velocity, a->angular_velocity, contact->arm_a));
        if (!(vec2_dot(velocity, velocity) < limit * limit)) return true;
    }
    return false;
}

bool stopping_read(StoppingRule *rule, const Settings *chosen, Error *error) {
    int more = rule->more;
    if (more == 0 && settings_get(chosen, "near") == NULL)
        return settings_get(chosen, "more") == NULL ||
               error_input(error, "more", "needs near: sweeps follow while the residual is at least near");
    if (more == 0) more = STOPPING_MORE;
    if (!settings_float(chosen, "near", 0, 1e6f, &rule->near, error) ||
        !settings_int(chosen, "more", 1, SWEEPS_MAX, &more, error))
        return false;
    rule->more = (more + STOPPING_BLOCK - 1) / STOPPING_BLOCK * STOPPING_BLOCK;
    return true;
}

bool stopping_needs_more(const StoppingRule *rule, int done, const Sweeps *sweeps, const ContactProblem *problem) {
    return done < rule->more && residual_reaches(sweeps, problem->contact_count, rule->near);
}

bool stopping_needs_more_scalar(const StoppingRule *rule, int done, const ContactProblem *problem,
                                const ContactSolution *solution) {
    return done < rule->more && residual_reaches_scalar(problem, solution, rule->near);
}

bool stopping_run(const StoppingRule *rule, Sweeps *sweeps, const ContactProblem *problem, int k,
                  bool (*run)(Sweeps *, int)) {
    sweeps->block = rule->more > 0 ? STOPPING_BLOCK : 0;
    if (!run(sweeps, k)) return false;
    for (int done = 0; stopping_needs_more(rule, done, sweeps, problem); done += STOPPING_BLOCK)
        if (!run(sweeps, STOPPING_BLOCK)) return false;
    return true;
}
