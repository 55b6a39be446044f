/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What every solution by impulses must be. */
#pragma once
#include "testing.h"

#include "engine/engine.h"

/* Velocities are those that the impulses make: b gets +, a gets -. Relative to the sum of the impulses of a body, as
   redundant contacts may have large ones that cancel. float: they were added up in it, as sweeps do. */
static inline void assert_velocities_fit(const ContactProblem *problem, const ContactSolution *found, bool in_float) {
    const double rounding = in_float || found->fallbacks.by_sweeps > 0 ? 1e-4 : 1e-6;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        double v[3] = {(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity}, sum = 1;
        double turns = 1 + fabs(v[2]);
        for (int k = 0; k < problem->contact_count; k++) {
            const ContactPoint *contact = &problem->contacts[k];
            if (contact->a != i && contact->b != i) continue;
            const double sign = contact->a == i ? -1 : 1;
            const double l = sign * (double)found->impulses[k].normal, t = sign * (double)found->impulses[k].tangent;
            const double x = l * (double)contact->normal.x + t * (double)contact->normal.y;
            const double y = l * (double)contact->normal.y - t * (double)contact->normal.x;
            const Vec2 arm = contact->a == i ? contact->arm_a : contact->arm_b;
            const double turn = (double)body->inv_inertia * ((double)arm.x * y - (double)arm.y * x);
            v[0] += (double)body->inv_mass * x;
            v[1] += (double)body->inv_mass * y;
            v[2] += turn;
            sum += (double)body->inv_mass * (fabs(l) + fabs(t));
            turns += fabs(turn);
        }
        sum += fabs(v[0]) + fabs(v[1]);
        assert_near(found->velocities[i].linear.x, v[0], rounding * sum);
        assert_near(found->velocities[i].linear.y, v[1], rounding * sum);
        assert_near(found->velocities[i].angular, v[2], rounding * turns);
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
