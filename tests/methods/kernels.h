/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every sweep kernel of this processor against the scalar reference implementation. */
#pragma once
#include "momentum_scalar.h"
#include "owned.h"

#include "methods/momentum.h"
#include "methods/sweeps.h"

/* As the engine sweeps. */
static const SequentialOptions engine_options = {.accumulate = true, .warm = true};

static inline ContactSolution make_solution(const ContactProblem *problem) {
    ContactSolution solution = {calloc((size_t)problem->body_count + 1, sizeof(BodyVelocity)),
                                calloc((size_t)problem->contact_count + 1, sizeof(ContactImpulse)),
                                0,
                                {0}};
    assert_non_null(solution.velocities);
    assert_non_null(solution.impulses);
    return solution;
}

static inline void free_solution(ContactSolution *solution) {
    free(solution->velocities);
    free(solution->impulses);
}

OWNED_VALUE(ContactSolution, free_solution)

/* The rounding error of the largest velocity of a problem, m/s and rad/s: the unit of differences between solvers that
   perform the same operations in another order. */
static inline double rounding_of(const ContactProblem *problem) {
    float most = 1;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        most = fmaxf(most, fmaxf(hypotf(body->velocity.x, body->velocity.y), fabsf(body->angular_velocity)));
    }
    return ldexp((double)most, -24);
}

static inline void assert_same_bits(const ContactProblem *problem, const ContactSolution *found,
                                    const ContactSolution *expected, const char *what) {
    if (memcmp(found->velocities, expected->velocities, (size_t)problem->body_count * sizeof *found->velocities) != 0 ||
        memcmp(found->impulses, expected->impulses, (size_t)problem->contact_count * sizeof *found->impulses) != 0)
        fail_msg("%s, %d bodies, %d contacts: other bits", what, problem->body_count, problem->contact_count);
}

/* Fails if the bits of any kernel differ from the scalar reference implementation. `sweeps` is reused from call to
   call, to test stale schedules. */
static inline void assert_kernels_agree(Sweeps sweeps[SWEEP_KERNELS], const ContactProblem *problem,
                                        const SequentialOptions *options, int iterations) {
    ContactSolution plain = make_solution(problem), fast = make_solution(problem);
    sequential_impulses_solve(problem, options, iterations, &plain);
    for (SweepKernel kernel = 0; kernel < SWEEP_KERNELS; kernel++) {
        if (!sweeps_can(kernel)) continue;
        assert_true(sweeps_begin(&sweeps[kernel], kernel, problem, options->warm));
        assert_true(sweeps_run(&sweeps[kernel], iterations));
        assert_true(sweeps_end(&sweeps[kernel], &fast));
        assert_same_bits(problem, &fast, &plain, kernel == SWEEP_ONE_BY_ONE ? "one by one" : "lanes");
    }
    free_solution(&plain);
    free_solution(&fast);
}

/* The same for sweeps with momentum, in the order of colours or as the contacts are given. */
static inline void assert_momentum_kernels_agree(Sweeps sweeps[SWEEP_KERNELS], const ContactProblem *problem,
                                                 bool coloured, const float *factors, int iterations) {
    ContactSolution plain = make_solution(problem), before = make_solution(problem), fast = make_solution(problem);
    Colours colours = {0};
    assert_true(colours_order(&colours, problem));
    if (!coloured)
        for (int i = 0; i < problem->contact_count; i++) colours.visits[i] = i;
    momentum_solve_scalar(problem, colours.visits, factors, iterations, &before, &plain);
    for (SweepKernel kernel = 0; kernel < SWEEP_KERNELS; kernel++) {
        if (!sweeps_can(kernel)) continue;
        assert_true(coloured ? sweeps_begin_coloured(&sweeps[kernel], kernel, problem)
                             : sweeps_begin(&sweeps[kernel], kernel, problem, true));
        assert_true(sweeps_run_momentum(&sweeps[kernel], factors, iterations));
        assert_true(sweeps_end(&sweeps[kernel], &fast));
        assert_same_bits(problem, &fast, &plain, kernel == SWEEP_ONE_BY_ONE ? "momentum one by one" : "momentum lanes");
    }
    colours_free(&colours);
    free_solution(&plain);
    free_solution(&before);
    free_solution(&fast);
}

static inline void free_kernels(Sweeps sweeps[SWEEP_KERNELS]) {
    for (int i = 0; i < SWEEP_KERNELS; i++) sweeps_free(&sweeps[i]);
}
