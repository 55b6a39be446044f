/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every sweep kernel that this processor has beside the plain text. */
#pragma once
#include "testing.h"

#include "solvers/sequential_impulses.h"
#include "solvers/sweeps.h"

static inline ContactSolution make_solution(const ContactProblem *problem) {
    ContactSolution solution = {calloc((size_t)problem->body_count + 1, sizeof(BodyVelocity)),
                                calloc((size_t)problem->contact_count + 1, sizeof(ContactImpulse))};
    assert_non_null(solution.velocities);
    assert_non_null(solution.impulses);
    return solution;
}

static inline void free_solution(ContactSolution *solution) {
    free(solution->velocities);
    free(solution->impulses);
}

/* Fails where any kernel gives another bit than the plain text. `sweeps` is used again from call to call, so that
   stale schedules are met too. */
static inline void assert_kernels_agree(Sweeps sweeps[SWEEP_KERNELS], const ContactProblem *problem, int iterations) {
    ContactSolution plain = make_solution(problem), fast = make_solution(problem);
    sequential_impulses_solve(problem, iterations, true, &plain);
    for (SweepKernel kernel = 0; kernel < SWEEP_KERNELS; kernel++) {
        if (!sweeps_can(kernel)) continue;
        assert_true(sweeps_begin(&sweeps[kernel], kernel, problem));
        assert_true(sweeps_run(&sweeps[kernel], iterations));
        assert_true(sweeps_end(&sweeps[kernel], &fast));
        if (memcmp(fast.velocities, plain.velocities, (size_t)problem->body_count * sizeof *plain.velocities) != 0 ||
            memcmp(fast.impulses, plain.impulses, (size_t)problem->contact_count * sizeof *plain.impulses) != 0)
            fail_msg("kernel %d, %d bodies, %d contacts, %d iterations: other bits", (int)kernel, problem->body_count,
                     problem->contact_count, iterations);
    }
    free_solution(&plain);
    free_solution(&fast);
}

static inline void free_kernels(Sweeps sweeps[SWEEP_KERNELS]) {
    for (int i = 0; i < SWEEP_KERNELS; i++) sweeps_free(&sweeps[i]);
}
