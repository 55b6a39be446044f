/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/residual.h"

static Vec2 point_velocity(const SweepBody *body, Vec2 arm) {
    return vec2_add(vec2(body->x, body->y), scalar_cross_vec2(body->spin, arm));
}

/* (m/s)^2. Branchless: these branches mispredict. */
static float squared_residual(const SweepPair *pair, int k, const SweepBody *a, const SweepBody *b) {
    const SweepPoint *point = &pair->points[k];
    const Vec2 velocity = vec2_sub(point_velocity(b, point->arm_b), point_velocity(a, point->arm_a));
    const float missing = point->bias - vec2_dot(velocity, pair->normal);
    const float closing = missing > 0 ? missing : 0;
    const float residual = pair->sums[k].normal > 0 ? missing : closing;
    return residual * residual;
}

bool residual_reaches(const Sweeps *sweeps, int contact_count, float limit) {
    const float enough = limit * limit * (float)contact_count;
    float sum = 0;
    for (int i = 0; i < sweeps->pair_count; i++) {
        const SweepPair *pair = &sweeps->pairs[i];
        const SweepBody *a = &sweeps->bodies[sweep_body_at(sweeps->ends[i].a)];
        const SweepBody *b = &sweeps->bodies[sweep_body_at(sweeps->ends[i].b)];
        const float first = squared_residual(pair, 0, a, b), second = squared_residual(pair, 1, a, b);
        sum += first;
        sum += sweep_pair_points(pair) == 2 ? second : 0;
        if (sum >= enough) return true;
    }
    return false;
}
