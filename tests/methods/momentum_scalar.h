/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps with momentum, contact by contact: the scalar reference implementation of methods/momentum.h. */
#pragma once
#include "engine/engine.h"
#include "methods/sweeps.h"

#include <stdint.h>

/* Adds factor times the change since *before to *now. A factor or change of 0 must keep all bits: + 0 turns -0 into 0,
   and x - 0 is x even for x = -0. */
static inline void momentum_extrapolate(float *now, float *before, float factor) {
    float next = *now - (factor * (*before - *now) + 0.0f);
    *before = *now;
    *now = next;
}

static inline void extrapolate_all(const ContactProblem *problem, float factor, ContactSolution *before,
                                   ContactSolution *now) {
    for (int i = 0; i < problem->body_count; i++) {
        momentum_extrapolate(&now->velocities[i].linear.x, &before->velocities[i].linear.x, factor);
        momentum_extrapolate(&now->velocities[i].linear.y, &before->velocities[i].linear.y, factor);
        momentum_extrapolate(&now->velocities[i].angular, &before->velocities[i].angular, factor);
    }
    for (int i = 0; i < problem->contact_count; i++) {
        momentum_extrapolate(&now->impulses[i].normal, &before->impulses[i].normal, factor);
        momentum_extrapolate(&now->impulses[i].tangent, &before->impulses[i].tangent, factor);
    }
}

static inline void begin_scalar(const ContactProblem *problem, const int32_t *visits, ContactSolution *solution) {
    static const SequentialOptions cold = {.accumulate = false};
    sequential_impulses_begin(problem, &cold, solution);
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[visits[i]];
        const ContactImpulse warm = {contact->warm_normal, contact->warm_tangent};
        solution->impulses[visits[i]] = warm;
        contact_push(solution->velocities, contact, problem->bodies, warm);
    }
}

/* Scalar reference implementation: `count` sweeps over the contacts visits[contact_count]; before each sweep s > 0 the
   extrapolation by factors[s] >= 0. `before`: work space, a solution of the same size. sweeps_run_momentum gives the
   same bits. */
static inline void momentum_solve_scalar(const ContactProblem *problem, const int32_t *visits, const float *factors,
                                         int count, ContactSolution *before, ContactSolution *solution) {
    static const SequentialOptions options = {.accumulate = true, .warm = true};
    begin_scalar(problem, visits, solution);
    begin_scalar(problem, visits, before);
    for (int sweep = 0; sweep < count; sweep++) {
        extrapolate_all(problem, factors[sweep], before, solution);
        for (int i = 0; i < problem->contact_count; i++)
            sequential_impulses_visit(problem, &options, visits[i], 1, solution);
    }
}
