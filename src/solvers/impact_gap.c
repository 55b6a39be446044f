/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/impact_gap.h"

static Vec2 point_velocity(const SweepBody *body, Vec2 arm) {
    return vec2_add(vec2(body->x, body->y), scalar_cross_vec2(body->spin, arm));
}

bool impact_gap_reaches(const Sweeps *sweeps, const ContactProblem *problem, float gate) {
    const float enough = gate * gate * (float)problem->contact_count;
    float sum = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const Vec2 velocity = vec2_sub(point_velocity(&sweeps->bodies[contact->b], contact->arm_b),
                                       point_velocity(&sweeps->bodies[contact->a], contact->arm_a));
        const float missing = contact->bias - vec2_dot(velocity, contact->normal);
        if (missing < 0 && contact->warm_normal <= 0) continue;
        sum += missing * missing;
        if (sum >= enough) return true;
    }
    return false;
}
