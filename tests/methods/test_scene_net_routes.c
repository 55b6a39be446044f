/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sweeps of scene-net: after its network, and in calm steps. */
#include "residuals.h"
#include "known.h"

#include "methods/momentum.h"
#include "methods/residual.h"
#include "methods/stopping.h"

enum { MORE = 48, CALM_MORE = 24 };

static void put_warm_impulses_into_the_cone(RandomProblem *random) {
    for (int k = 0; k < random->problem.contact_count; k++) {
        ContactPoint *contact = &random->contacts[k];
        contact->warm_normal = fabsf(contact->warm_normal);
        const float limit = contact->friction * contact->warm_normal;
        contact->warm_tangent = fminf(fmaxf(contact->warm_tangent, -limit), limit);
    }
}

/* Everything that moves or pushes, so much less. */
static void calm(RandomProblem *random, float factor) {
    for (int i = 0; i < random->problem.body_count; i++) {
        random->bodies[i].velocity = vec2_scale(factor, random->bodies[i].velocity);
        random->bodies[i].angular_velocity *= factor;
    }
    for (int k = 0; k < random->problem.contact_count; k++) {
        random->contacts[k].bias *= factor;
        random->contacts[k].warm_normal *= factor;
        random->contacts[k].warm_tangent *= factor;
    }
}

/* `count` sweeps with momentum from the warm start, and 8 n more, up to `most`: the first n that leave a residual below
   `near`. Returns n. */
static int sweep_until(Known *known, const float *factors, int count, float near, int most) {
    const ContactProblem *problem = &known->random.problem;
    Momentum momentum = {0};
    float more_factors[MORE];
    for (int s = 0; s < MORE; s++) more_factors[s] = momentum_factor(s);
    int times = 0;
    for (bool more = true; more; times += more) {
        const StoppingRule rule = {.near = near, .more = 8 * times};
        assert_true(sweeps_begin_coloured(&momentum.sweeps, sweeps_best_kernel(), problem));
        assert_true(momentum_begin(&momentum, problem) && momentum_run(&momentum, factors, count));
        assert_true(momentum_run_more(&momentum, &rule, more_factors));
        more = 8 * times < most && residual_reaches(&momentum.sweeps, problem->contact_count, near);
    }
    assert_true(momentum_end(&momentum, &known->expected));
    momentum_free(&momentum);
    return times;
}

static int sweep_from_the_warm_start(Known *known) {
    const ContactProblem *problem = &known->random.problem;
    OWN(Sweeps) sweeps = {0};
    assert_true(sweeps_begin_coloured(&sweeps, sweeps_best_kernel(), problem));
    assert_true(residual_reaches(&sweeps, problem->contact_count, known->network->gate));
    return sweep_until(known, known->network->factors, AFTER, near_aim, MORE);
}

/* But for the sign of a 0, to which nothing was added. */
static void assert_same_velocities(const Known *known) {
    for (int i = 0; i < known->random.problem.body_count; i++) {
        const BodyVelocity *found = &known->found.velocities[i], *expected = &known->expected.velocities[i];
        assert_true(found->linear.x == expected->linear.x && found->linear.y == expected->linear.y);
        assert_true(found->angular == expected->angular);
    }
}

/* 10 sweeps, and 8, 16 or 24 more while the residual is 0.0075 m/s or more. */
static int sweep_calmly(Known *known) {
    float factors[REST / 2];
    for (int s = 0; s < REST / 2; s++) factors[s] = momentum_factor(s);
    return sweep_until(known, factors, REST / 2, near_aim * 0.15f, CALM_MORE);
}

TEST(a_calm_step_takes_half_the_sweeps) {
    static Known known;
    uint32_t seed = 8;
    int more = 0, twice = 0;
    for (int run = 0; run < RUNS; run++) {
        make_known(&known, &seed, run, 0.7f);
        calm(&known.random, run % 2 == 0 ? 0.001f : 0.1f);
        known.network->gate = 1e6f;
        const int times = sweep_calmly(&known);
        more += times > 0;
        twice += times > 1;
        solve_by_network(&known);
        assert_same_bits(&known.random.problem, &known.found, &known.expected, "a calm step");
        assert_int_equal(known.found.fallbacks.beyond_training, 0);
        free_known(&known);
    }
    assert_in_range(more, RUNS / 8, RUNS - RUNS / 8);
    assert_in_range(twice, 1, RUNS - 1);
}

TEST(a_network_that_says_nothing_changes_nothing) {
    static Known known;
    uint32_t seed = 9;
    int more = 0, twice = 0;
    for (int run = 0; run < RUNS; run++) {
        make_known(&known, &seed, run, 0.7f);
        SceneNet *network = known.network;
        for (int i = 0; i < network->slot_count; i++) network->cap[i] = 1e6f;
        memset(network->rows, 0,
               (network->parameter_count - (size_t)(network->rows - network->parameters)) * sizeof(float));
        for (int s = 1; s < AFTER && run % 2 == 1; s++) network->factors[s] = 0.5f;
        scene_net_pack(network);
        calm(&known.random, run % 4 == 0 ? 0.01f : run % 4 == 1 ? 0.1f : 1);
        put_warm_impulses_into_the_cone(&known.random);
        network->gate = 0.7f * (float)residual_of(&known.random.problem);
        const int times = sweep_from_the_warm_start(&known);
        more += times > 0;
        twice += times > 1;
        solve_by_network(&known);
        assert_same_velocities(&known);
        free_known(&known);
    }
    assert_in_range(more, RUNS / 8, RUNS - RUNS / 8);
    assert_in_range(twice, 1, RUNS - 1);
}

/* The network's file has factors and outputs that must not matter. */
TEST(without_its_prediction_it_is_momentum_with_the_same_stopping_rule) {
    char text[400];
    static Known known;
    uint32_t seed = 10;
    int other = 0;
    for (int run = 0; run < RUNS; run++) {
        make_known(&known, &seed, run, 0.7f);
        for (int s = 1; s < AFTER && run % 2 == 1; s++) known.network->factors[s] = 0.5f;
        known.network->gate = 0.7f * (float)residual_of(&known.random.problem);
        const char *path = temporary_path("known.npz");
        assert_ok(scene_net_write(known.network, path, &error), error);
        for (int more = 8; more <= MORE; more += 40) {
            snprintf(text, sizeof text, "network=%s,near=0.05,more=%d,net=off", path, more);
            solve_with(&solver_scene_net, text, &known.random.problem, &known.found);
            snprintf(text, sizeof text, "k=%d,near=0.05,more=%d", AFTER, more);
            solve_with(&solver_momentum, text, &known.random.problem, &known.expected);
            assert_same_bits(&known.random.problem, &known.found, &known.expected, "without prediction");
            assert_int_equal(known.found.fallbacks.outside_cone, 0);
        }
        snprintf(text, sizeof text, "network=%s,near=0.05", path);
        solve_with(&solver_scene_net, text, &known.random.problem, &known.found);
        other += !same_bits(&known);
        free_known(&known);
    }
    assert_in_range(other, RUNS - 5, RUNS);
}

RUN_TESTS(NULL, NULL)
