/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every solution by impulses must be. */
#pragma once
#include "testing.h"

#include "engine/engine.h"

/* Velocities are those that the impulses make: b gets +, a gets -. */
static inline void assert_consistent(const ContactProblem *problem, const ContactSolution *solution) {
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        double x = (double)body->velocity.x, y = (double)body->velocity.y, spin = (double)body->angular_velocity;
        for (int k = 0; k < problem->contact_count; k++) {
            const ContactPoint *contact = &problem->contacts[k];
            if (contact->a != i && contact->b != i) continue;
            ContactImpulse p = solution->impulses[k];
            Vec2 tangent = vec2_cross_scalar(contact->normal, 1.0f);
            Vec2 sum = vec2_add(vec2_scale(p.normal, contact->normal), vec2_scale(p.tangent, tangent));
            double sign = contact->a == i ? -1 : 1;
            Vec2 arm = contact->a == i ? contact->arm_a : contact->arm_b;
            x += sign * (double)(body->inv_mass * sum.x);
            y += sign * (double)(body->inv_mass * sum.y);
            spin += sign * (double)(body->inv_inertia * vec2_cross(arm, sum));
        }
        assert_near(solution->velocities[i].linear.x, x, 1e-3);
        assert_near(solution->velocities[i].linear.y, y, 1e-3);
        assert_near(solution->velocities[i].angular, spin, 2e-3);
    }
}

/* As assert_consistent(), in double: relative to the sum of the impulses of a body, as redundant contacts may have
   large ones that cancel. */
static inline void assert_velocities_fit(const ContactProblem *problem, const ContactSolution *found) {
    const double rounding = found->fallbacks.by_sweeps > 0 ? 1e-4 : 1e-6; /* sweeps add up float changes */
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        double x = (double)body->velocity.x, y = (double)body->velocity.y, sum = fabs(x) + fabs(y) + 1;
        for (int k = 0; k < problem->contact_count; k++) {
            const ContactPoint *contact = &problem->contacts[k];
            if (contact->a != i && contact->b != i) continue;
            const double inverse = contact->a == i ? -(double)body->inv_mass : (double)body->inv_mass;
            const double l = inverse * (double)found->impulses[k].normal,
                         t = inverse * (double)found->impulses[k].tangent;
            x += l * (double)contact->normal.x + t * (double)contact->normal.y;
            y += l * (double)contact->normal.y - t * (double)contact->normal.x;
            sum += fabs(l) + fabs(t);
        }
        assert_near(found->velocities[i].linear.x, x, rounding * sum);
        assert_near(found->velocities[i].linear.y, y, rounding * sum);
    }
}

/* Impulses push, and friction is at most mu times the normal impulse. */
static inline void assert_in_cone(const ContactProblem *problem, const ContactImpulse *impulses) {
    for (int i = 0; i < problem->contact_count; i++) {
        assert_true(impulses[i].normal >= 0);
        assert_true(fabsf(impulses[i].tangent) <= problem->contacts[i].friction * impulses[i].normal);
    }
}

/* N s: momentum of all bodies, which move; before the solve with NULL. */
static inline void linear_momentum(const ContactProblem *problem, const BodyVelocity *after, double sum[2]) {
    sum[0] = sum[1] = 0;
    for (int i = 0; i < problem->body_count; i++) {
        Vec2 v = after != NULL ? after[i].linear : problem->bodies[i].velocity;
        sum[0] += (double)v.x / (double)problem->bodies[i].inv_mass;
        sum[1] += (double)v.y / (double)problem->bodies[i].inv_mass;
    }
}
