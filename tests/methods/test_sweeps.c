/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fast sweeps have the bits of the plain text, on problems that no scene would give. */
#include "kernels.h"

#include "random_problem.h"
#include "worlds.h"

TEST(random_problems_have_the_bits_of_the_plain_text) {
    static RandomProblem random;
    Sweeps sweeps[SWEEP_KERNELS] = {{0}};
    uint32_t seed = 3;
    const int iterations[] = {1, 2, 10, 16, 17, 40};
    for (int i = 0; i < 600; i++) {
        int bodies = 2 + i % (BODIES_MAX - 1);
        const float densities[] = {0.5f, 4.0f / (float)bodies, 0.7f / (float)bodies};
        make_random(&random, &seed, bodies, densities[i % 3], i % 4 == 0 ? 30.0f : 2.0f);
        if (i % 5 == 0) calm_down(&random, &seed);
        const SequentialOptions options = {.accumulate = true, .warm = i % 7 != 0};
        assert_kernels_agree(sweeps, &random.problem, &options, iterations[i % 6]);
    }
    free_kernels(sweeps);
}

/* Zeros among the factors too: they leave the sign of a zero. */
TEST(random_problems_with_momentum_have_the_bits_of_the_plain_text) {
    static RandomProblem random;
    Sweeps sweeps[SWEEP_KERNELS] = {{0}};
    uint32_t seed = 4;
    const int iterations[] = {1, 2, 10, 16, 17, 19, 33, 40};
    for (int i = 0; i < 600; i++) {
        int bodies = 2 + i % (BODIES_MAX - 1);
        const float densities[] = {0.5f, 4.0f / (float)bodies, 0.7f / (float)bodies};
        make_random(&random, &seed, bodies, densities[i % 3], 2.0f);
        if (i % 5 == 0) calm_down(&random, &seed);
        float factors[40];
        for (int k = 0; k < 40; k++) factors[k] = fabsf(any_number(&seed, 0.7f));
        assert_momentum_kernels_agree(sweeps, &random.problem, i % 2 == 0, factors, iterations[i / 2 % 8]);
    }
    free_kernels(sweeps);
}

/* In parts of an even number of sweeps as in one run; the first factor of a part but the first counts. */
TEST(a_run_in_parts_has_the_bits_of_one) {
    enum { SWEEPS = 30 };
    static RandomProblem random;
    Sweeps sweeps[SWEEP_KERNELS] = {{0}};
    uint32_t seed = 14;
    for (int i = 0; i < 200; i++) {
        const int bodies = 2 + i % (BODIES_MAX - 1), parts[] = {2 + 2 * (i % 6), 8, 20 - 2 * (i % 6)};
        make_random(&random, &seed, bodies, i % 2 == 0 ? 0.5f : 4.0f / (float)bodies, 2);
        if (i % 5 == 0) calm_down(&random, &seed);
        float factors[SWEEPS];
        for (int k = 0; k < SWEEPS; k++) factors[k] = fabsf(any_number(&seed, 0.7f));
        OWN(ContactSolution) whole = make_solution(&random.problem), found = make_solution(&random.problem);
        for (SweepKernel kernel = 0; kernel < SWEEP_KERNELS; kernel++) {
            if (!sweeps_can(kernel)) continue;
            assert_true(sweeps_begin_coloured(&sweeps[kernel], kernel, &random.problem));
            assert_true(sweeps_run_momentum(&sweeps[kernel], factors, SWEEPS));
            assert_true(sweeps_end(&sweeps[kernel], &whole));
            assert_true(sweeps_begin_coloured(&sweeps[kernel], kernel, &random.problem));
            assert_true(sweeps_run_momentum(&sweeps[kernel], factors, parts[0]));
            assert_true(sweeps_continue_momentum(&sweeps[kernel], factors + parts[0], parts[1]));
            assert_true(sweeps_continue_momentum(&sweeps[kernel], factors + parts[0] + parts[1], parts[2]));
            assert_true(sweeps_end(&sweeps[kernel], &found));
            assert_same_bits(&random.problem, &found, &whole, "in parts");
        }
    }
    free_kernels(sweeps);
}

/* Of the same pairs, as solvers with more than one number of sweeps have it: the odd sweep needs its own schedule. */
TEST(schedules_fit_when_the_number_of_sweeps_changes) {
    static RandomProblem random;
    uint32_t seed = 21;
    Sweeps sweeps[SWEEP_KERNELS] = {0};
    float factors[40];
    for (int k = 0; k < 40; k++) factors[k] = 0.5f;
    make_random(&random, &seed, 60, 0.2f, 2);
    const int counts[] = {8, 7, 8, 3, 14, 33, 2};
    for (int i = 0; i < 7; i++) assert_momentum_kernels_agree(sweeps, &random.problem, true, factors, counts[i]);
    for (int i = 0; i < 7; i++) assert_kernels_agree(sweeps, &random.problem, &engine_options, counts[i]);
    for (int kernel = 0; kernel < SWEEP_KERNELS; kernel++) sweeps[kernel].block = 8;
    for (int i = 0; i < 7; i++) assert_kernels_agree(sweeps, &random.problem, &engine_options, counts[i]);
    free_kernels(sweeps);
}

TEST(momentum_of_factor_zero_has_the_bits_of_the_engine) {
    static RandomProblem random;
    static const float zeros[17];
    int32_t as_given[CONTACTS_MAX];
    for (int i = 0; i < CONTACTS_MAX; i++) as_given[i] = i;
    uint32_t seed = 6;
    for (int i = 0; i < 100; i++) {
        make_random(&random, &seed, 10 + i % 60, 0.1f, 2.0f);
        OWN(ContactSolution) engine = make_solution(&random.problem), before = make_solution(&random.problem);
        OWN(ContactSolution) momentum = make_solution(&random.problem);
        sequential_impulses_solve(&random.problem, &engine_options, 17, &engine);
        momentum_solve_scalar(&random.problem, as_given, zeros, 17, &before, &momentum);
        assert_same_bits(&random.problem, &momentum, &engine, "factors 0");
    }
}

static int find_fixed(const RandomProblem *random) {
    int body = 0;
    while (random->bodies[body].inv_mass != 0) body++;
    return body;
}

/* The same pairs again, with other numbers: the schedule of the last step is used again. Not so when a body begins to
   move. */
TEST(a_kept_schedule_serves_the_same_pairs) {
    static RandomProblem random;
    Sweeps sweeps[SWEEP_KERNELS] = {{0}};
    uint32_t seed = 5;
    make_random(&random, &seed, 60, 0.08f, 1);
    assert_true(random.problem.contact_count > 150);
    for (int i = 0; i < 20; i++) {
        for (int k = 0; k < random.problem.contact_count; k++) random.contacts[k].bias = any_number(&seed, 1);
        assert_kernels_agree(sweeps, &random.problem, &engine_options, 10 + i / 10);
        ProblemBody *fixed = &random.bodies[find_fixed(&random)];
        if (i % 4 == 0) fixed->inv_mass = fixed->inv_inertia = 1;
    }
    free_kernels(sweeps);
}

TEST(no_contacts_leave_the_velocities) {
    static RandomProblem random;
    Sweeps sweeps[SWEEP_KERNELS] = {{0}};
    uint32_t seed = 9;
    make_random(&random, &seed, 30, 0, 1);
    assert_int_equal(random.problem.contact_count, 0);
    assert_kernels_agree(sweeps, &random.problem, &engine_options, 10);
    free_kernels(sweeps);
}

/* Where numbers overflow the order of visits shows; then the engine falls back to the plain text. */
TEST(what_overflows_has_the_bits_of_the_plain_text) {
    static RandomProblem random;
    uint32_t seed = 11;
    make_random(&random, &seed, 60, 0.1f, 1);
    random.contacts[40].mass_normal = 1e38f;
    OWN(ContactSolution) plain = make_solution(&random.problem), fast = make_solution(&random.problem);
    sequential_impulses_solve(&random.problem, &engine_options, 10, &plain);
    OWN(ContactSolver) engine = make_engine("");
    assert_true(engine.kind->solve(engine.state, &random.problem, &fast, &error));
    int lost = 0;
    for (int i = 0; i < random.problem.body_count; i++) {
        assert_int_equal(isfinite(plain.velocities[i].linear.x), isfinite(fast.velocities[i].linear.x));
        lost += !isfinite(plain.velocities[i].linear.x);
    }
    assert_in_range(lost, 1, random.problem.body_count);
    assert_memory_equal(fast.velocities, plain.velocities,
                        (size_t)random.problem.body_count * sizeof *plain.velocities);
}

TEST(one_by_one_works_everywhere) {
    assert_true(sweeps_can(SWEEP_ONE_BY_ONE));
    assert_false(sweeps_can(SWEEP_KERNELS));
}

RUN_TESTS(NULL, NULL)
