/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method sain: without its network it is the engine, and answers that cannot be used are discarded. */
#include "kernels.h"
#include "random_problem.h"
#include "methods/sain_networks.h"

#include "methods/sain.h"

enum { RUNS = 12 };

static void fill_heap(RandomProblem *random, uint32_t *seed, int run) {
    make_random(random, seed, 3 + run, 0.3f, 1);
    for (int i = 0; i < random->problem.body_count; i++) random->bodies[i].size = vec2(1, 1);
}

static void solve_by(const SainNetwork *network, const ContactProblem *problem, ContactSolution *solution) {
    Error error = {0};
    ContactSolver solver;
    assert_ok(sain_make(&solver, network, &error), error);
    assert_ok(solver.kind->solve(solver.state, problem, solution, &error), error);
    free_solver(&solver);
}

static bool is_finite(const ContactProblem *problem, const ContactSolution *solution) {
    for (int i = 0; i < problem->body_count; i++)
        if (!isfinite(solution->velocities[i].linear.x) || !isfinite(solution->velocities[i].linear.y) ||
            !isfinite(solution->velocities[i].angular))
            return false;
    return true;
}

TEST(without_its_network_it_is_the_engine) {
    static RandomProblem random;
    uint32_t seed = 5;
    OWN(SainNetwork) network;
    const char *path = temporary_path("sain.npz");
    make_sain_network(&network, &seed, 1);
    assert_ok(sain_network_write(&network, path, &error), error);
    for (int run = 0; run < RUNS; run++) {
        fill_heap(&random, &seed, run);
        OWN(ContactSolution) found = make_solution(&random.problem), engine = make_solution(&random.problem);
        solve_with(&solver_engine, "k=10", &random.problem, &engine);
        solve_with(&solver_sain, printed("network=%s,net=off", path), &random.problem, &found);
        assert_same_bits(&random.problem, &found, &engine, "net=off");
    }
}

/* Impulses stay those of the engine, velocities do not. */
TEST(a_network_corrects_velocities_only) {
    static RandomProblem random;
    uint32_t seed = 6;
    OWN(SainNetwork) network;
    make_sain_network(&network, &seed, 0.5f);
    fill_heap(&random, &seed, 8);
    OWN(ContactSolution) engine = make_solution(&random.problem), found = make_solution(&random.problem);
    solve_with(&solver_engine, "k=10", &random.problem, &engine);
    const size_t impulses = (size_t)random.problem.contact_count * sizeof *engine.impulses;
    solve_by(&network, &random.problem, &found);
    assert_true(
        memcmp(found.velocities, engine.velocities, (size_t)random.problem.body_count * sizeof *found.velocities) != 0);
    assert_true(found.momentum_error > 0);
    assert_memory_equal(found.impulses, engine.impulses, impulses);
    assert_int_equal(found.fallbacks.not_finite, 0);
    assert_int_equal(found.fallbacks.beyond_training, 0);
}

/* Closed form: the sum of mass times correction. */
TEST(created_momentum_is_that_of_the_corrections) {
    static RandomProblem random;
    uint32_t seed = 11;
    SainNetwork network;
    make_sain_network(&network, &seed, 0.5f);
    fill_heap(&random, &seed, 9);
    OWN(ContactSolution) engine = make_solution(&random.problem), found = make_solution(&random.problem);
    solve_with(&solver_engine, "k=10", &random.problem, &engine);
    solve_by(&network, &random.problem, &found);
    double sum = 0;
    for (int i = 0; i < random.problem.body_count; i++) {
        if (random.bodies[i].inv_mass == 0.0f) continue;
        const Vec2 change = vec2_sub(found.velocities[i].linear, engine.velocities[i].linear);
        sum += hypot((double)change.x, (double)change.y) / (double)random.bodies[i].inv_mass;
    }
    assert_near(found.momentum_error, sum, 1e-4 * sum);
    sain_network_destroy(&network);
}

TEST(states_beyond_training_are_left_to_the_engine) {
    static RandomProblem random;
    uint32_t seed = 7;
    SainNetwork network;
    make_sain_network(&network, &seed, 0.5f);
    for (int i = 0; i < SAIN_PAIR_INPUTS; i++) network.pair_low[i] = 1e6f;
    for (int run = 0; run < RUNS; run++) {
        fill_heap(&random, &seed, run);
        if (random.problem.contact_count == 0) continue;
        OWN(ContactSolution) engine = make_solution(&random.problem), found = make_solution(&random.problem);
        solve_with(&solver_engine, "k=10", &random.problem, &engine);
        solve_by(&network, &random.problem, &found);
        assert_same_bits(&random.problem, &found, &engine, "beyond training");
        assert_int_equal(found.fallbacks.beyond_training, 1);
    }
    sain_network_destroy(&network);
}

/* Weights of any size: what is not finite or beyond the limit never reaches a body. */
TEST(useless_answers_are_discarded) {
    static RandomProblem random;
    uint32_t seed = 9;
    OWN(SainNetwork) network;
    make_sain_network(&network, &seed, 1e38f);
    int discarded = 0;
    for (int run = 0; run < RUNS; run++) {
        fill_heap(&random, &seed, run);
        OWN(ContactSolution) found = make_solution(&random.problem);
        solve_by(&network, &random.problem, &found);
        assert_true(is_finite(&random.problem, &found));
        discarded += found.fallbacks.not_finite;
    }
    assert_true(discarded > 20);
}

TEST(settings_are_checked) {
    assert_settings_refused(&solver_sain, "", "names no network");
    assert_settings_refused(&solver_sain, "network=/nowhere/x.npz", "/nowhere/x.npz");
}

RUN_TESTS(NULL, NULL)
