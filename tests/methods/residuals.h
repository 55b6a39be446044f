/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The residual of methods/residual.h, computed independently. */
#pragma once
#include "methods/kernels.h"

/* m/s; from the scalar warm start. */
static inline double residual_of(const ContactProblem *problem) {
    ContactSolution warm = make_solution(problem);
    sequential_impulses_begin(problem, &engine_options, &warm);
    double sum = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        const BodyVelocity *a = &warm.velocities[contact->a], *b = &warm.velocities[contact->b];
        const Vec2 of_a = vec2_add(a->linear, scalar_cross_vec2(a->angular, contact->arm_a));
        const Vec2 of_b = vec2_add(b->linear, scalar_cross_vec2(b->angular, contact->arm_b));
        const double missing = (double)(contact->bias - vec2_dot(vec2_sub(of_b, of_a), contact->normal));
        if (missing > 0 || warm.impulses[i].normal > 0) sum += missing * missing;
    }
    free_solution(&warm);
    return problem->contact_count > 0 ? sqrt(sum / problem->contact_count) : 0;
}
