/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The settings `near` and `more` of every iterative method. */
#include "kernels.h"
#include "random_problem.h"

#include "methods/momentum.h"
#include "methods/residual.h"
#include "methods/stopping.h"

static const ContactSolverKind *const kinds[] = {&solver_engine, &solver_nncg, &solver_momentum};
enum { KINDS = sizeof kinds / sizeof *kinds, IN_PLACE = 2 /* those whose blocks continue as if in one run */ };

/* Boxes side by side and on top of each other, which a heavy one strikes. */
static World *make_struck(float speed) {
    World *world = make_world();
    add_ground(world, 0.4f);
    for (int i = 0; i < 12; i++) add_box(world, 1, 0.4f, vec2(1.05f * (float)(i % 3), 0.5f + (float)(i / 3)));
    add_body(
        world,
        &(BodyDef){.size = {1, 1}, .mass = 8, .friction = 0.4f, .position = {1.3f, 4.49f}, .velocity = {1, -speed}});
    run_engine(world, "", 1);
    assert_true(world_problem(world)->contact_count >= 20);
    return world;
}

TEST(a_small_residual_is_as_good_as_converged) {
    OWN(World) *world = make_struck(6);
    const ContactProblem *problem = world_problem(world);
    OWN(ContactSolution) converged = make_solution(problem), found = make_solution(problem);
    sequential_impulses_solve(problem, &engine_options, 100000, &converged);
    for (int kind = 0; kind < KINDS; kind++) {
        solve_with(kinds[kind], "near=1e-5,more=20000", problem, &found);
        assert_velocities(found.velocities, converged.velocities, problem->body_count, 5e-3);
    }
}

/* The bits are those of a run of as many sweeps: the first k + 8 n with a residual below `near`, or the limit. Returns
   n. */
static int assert_stops_there(const ContactSolverKind *kind, const ContactProblem *problem, int k, float near,
                              int most) {
    char text[64];
    ContactSolution found = make_solution(problem), fixed = make_solution(problem);
    int blocks = 0;
    for (bool more = true; more; blocks += more) {
        snprintf(text, sizeof text, "k=%d", k + STOPPING_BLOCK * blocks);
        solve_with(kind, text, problem, &fixed);
        more = blocks < most && residual_reaches_scalar(problem, &fixed, near);
    }
    snprintf(text, sizeof text, "k=%d,near=%.9g,more=%d", k, (double)near, STOPPING_BLOCK * most - 3);
    solve_with(kind, text, problem, &found);
    assert_same_bits(problem, &found, &fixed, kind->description.name);
    free_solution(&found);
    free_solution(&fixed);
    return blocks;
}

/* Odd and even k, on few and many contacts: the schedules of k sweeps and of a block differ. */
TEST(sweeps_stop_at_the_first_block_below_near) {
    static const float near[] = {0.3f, 0.002f}; /* m/s */
    int between = 0, limit = 0;
    for (int kind = 0; kind < IN_PLACE; kind++) {
        int at_once = 0, runs = 0;
        for (int k = 1; k <= 21; k += 4)
            for (int speed = 0; speed <= 20; speed += 5) {
                OWN(World) *world = make_struck((float)speed);
                const int blocks = assert_stops_there(kinds[kind], world_problem(world), k, near[speed % 2], 3);
                at_once += blocks == 0;
                runs++;
                between += blocks > 0 && blocks < 3;
                limit += blocks == 3;
            }
        assert_in_range(at_once, 1, runs - 1);
    }
    assert_true(between > 5 && limit > 5);
}

TEST(random_problems_stop_there_too) {
    static RandomProblem random;
    uint32_t seed = 12;
    for (int run = 0; run < 30; run++) {
        make_random(&random, &seed, 2 + 2 * run, 0.2f, 1);
        for (int kind = 0; kind < IN_PLACE; kind++)
            assert_stops_there(kinds[kind], &random.problem, 1 + run % 11, 0.5f, 4);
    }
}

/* A solver keeps its schedules from step to step. */
TEST(one_solver_has_the_same_bits_step_after_step) {
    static RandomProblem random;
    for (int kind = 0; kind < KINDS; kind++) {
        uint32_t seed = 13;
        OWN(ContactSolver) kept = make_solver(kinds[kind], "k=7,near=0.3");
        for (int run = 0; run < 20; run++) {
            make_random(&random, &seed, 20 + 7 * (run / 2 % 4), 0.2f, 1);
            OWN(ContactSolution) found = make_solution(&random.problem), once = make_solution(&random.problem);
            assert_ok(kept.kind->solve(kept.state, &random.problem, &found, &error), error);
            solve_with(kinds[kind], "k=7,near=0.3", &random.problem, &once);
            assert_same_bits(&random.problem, &found, &once, kinds[kind]->description.name);
        }
    }
}

/* The first k sweeps, then one run of 8 n with momentum. Where a residual is measured, velocities are computed anew. */
static void sweep_with_momentum(const ContactProblem *problem, int n, ContactSolution *solution) {
    OWN(Sweeps) sweeps = {0};
    float first[7], more[48];
    for (int s = 0; s < 7; s++) first[s] = momentum_factor(s);
    for (int s = 0; s < 48; s++) more[s] = momentum_factor(s);
    assert_true(sweeps_begin_coloured(&sweeps, sweeps_best_kernel(), problem));
    assert_true(sweeps_run_momentum(&sweeps, first, 7));
    if (n > 0) sweeps_refresh(&sweeps, problem, NULL);
    for (int i = 0; i < n; i++) {
        const float *factors = more + STOPPING_BLOCK * i;
        assert_true(i == 0 ? sweeps_run_momentum(&sweeps, factors, STOPPING_BLOCK)
                           : sweeps_continue_momentum(&sweeps, factors, STOPPING_BLOCK));
        sweeps_refresh(&sweeps, problem, NULL);
    }
    assert_true(sweeps_end(&sweeps, solution));
}

/* As long as it does not begin anew. After the most sweeps, 48, it returns the best solution. */
TEST(momentum_continues_in_one_run) {
    OWN(World) *world = make_struck(5);
    const ContactProblem *problem = world_problem(world);
    OWN(ContactSolution) found = make_solution(problem), expected = make_solution(problem);
    int least = 6, most = 0, between = 0;
    for (float near = 4; near > 0.001f; near *= 0.7f) {
        int n = 0;
        sweep_with_momentum(problem, n, &expected);
        while (n < 6 && residual_reaches_scalar(problem, &expected, near)) sweep_with_momentum(problem, ++n, &expected);
        const char *text = printed("k=7,near=%.9g", (double)near);
        solve_with(&solver_momentum, text, problem, &found);
        if (n < 6) assert_same_bits(problem, &found, &expected, text);
        least = n < least ? n : least;
        most = n > most ? n : most;
        between += n > 1 && n < 6;
    }
    assert_true(least == 0 && most == 6 && between > 0);
}

/* In a pyramid whose top a heavy box strikes. */
TEST(momentum_converges) {
    OWN(World) *world = make_world();
    add_ground(world, 0.2f);
    for (int row = 0; row < 20; row++)
        for (int i = row; i < 20; i++)
            add_box(world, 1, 0.2f, vec2(1.1f * ((float)i - 0.5f * (float)row), 0.499f + 0.998f * (float)row));
    add_body(
        world,
        &(BodyDef){.size = {1, 1}, .mass = 50, .friction = 0.2f, .position = {10.5f, 20.4f}, .velocity = {-6, -20}});
    run_engine(world, "", 3);
    const ContactProblem *problem = world_problem(world);
    OWN(ContactSolution) found = make_solution(problem);
    solve_with(&solver_momentum, "k=4000", problem, &found);
    assert_false(residual_reaches_scalar(problem, &found, 0.003f));
    solve_with(&solver_momentum, "near=1e-9,more=4000", problem, &found);
    assert_false(residual_reaches_scalar(problem, &found, 0.003f));
}

/* Impulses that are clamped one by one take another way through the engine. */
TEST(an_engine_that_does_not_accumulate_stops_too) {
    OWN(World) *world = make_struck(10);
    const ContactProblem *problem = world_problem(world);
    OWN(ContactSolution) found = make_solution(problem), expected = make_solution(problem);
    solve_with(&solver_engine, "accumulate=off,k=5,near=1e6", problem, &found);
    solve_with(&solver_engine, "accumulate=off,k=5", problem, &expected);
    assert_same_bits(problem, &found, &expected, "no more");
    solve_with(&solver_engine, "accumulate=off,k=5,near=0,more=16", problem, &found);
    solve_with(&solver_engine, "accumulate=off,k=21", problem, &expected);
    assert_same_bits(problem, &found, &expected, "all");
}

RUN_TESTS(NULL, NULL)
