/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/impact_gap.h"

static Vec2 point_velocity(const SweepBody *body, Vec2 arm) {
    return vec2_add(vec2(body->x, body->y), scalar_cross_vec2(body->spin, arm));
}

static int32_t body_of(int32_t end) { return end < 0 ? ~end : end; }

bool impact_gap_reaches(const Sweeps *sweeps, int contact_count, float gate) {
    const float enough = gate * gate * (float)contact_count;
    float sum = 0;
    for (int i = 0; i < sweeps->pair_count; i++) {
        const SweepPair *pair = &sweeps->pairs[i];
        const SweepBody *a = &sweeps->bodies[body_of(sweeps->ends[i].a)];
        const SweepBody *b = &sweeps->bodies[body_of(sweeps->ends[i].b)];
        for (int k = 0; k < sweep_pair_points(pair); k++) {
            const SweepPoint *point = &pair->points[k];
            const Vec2 velocity = vec2_sub(point_velocity(b, point->arm_b), point_velocity(a, point->arm_a));
            const float missing = point->bias - vec2_dot(velocity, pair->normal);
            if (missing < 0 && !(pair->sums[k].normal > 0)) continue;
            sum += missing * missing;
            if (sum >= enough) return true;
        }
    }
    return false;
}
