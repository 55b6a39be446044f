/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method scene-net with random networks on random problems: what it keeps whatever the network says, and where the
   network has no say. */
#include "gaps.h"
#include "kernels.h"
#include "slot_problems.h"

#include "solvers/impact_gap.h"
#include "solvers/scene_net.h"

#include <float.h>
#include <math.h>

enum { RUNS = 40, AFTER = 6, REST = 20, MORE = 48, CALM_MORE = 24 };

/* A problem whose step a network knows. */
typedef struct Known {
    RandomProblem random;
    SlotNetwork *network;
    ContactSolution found, expected;
} Known;

static void make_known(Known *known, uint32_t *seed, int run, float share) {
    known->network = make_slot_problem(&known->random, seed, 3 + run, 0.4f, share);
    while (known->random.problem.contact_count < 2) {
        slot_network_destroy(known->network);
        known->network = make_slot_problem(&known->random, seed, 3 + run, 0.4f, share);
    }
    SlotNetwork *network = known->network;
    strcpy(network->scene, "random");
    known->random.problem.bomb = network->bomb;
    network->bomb_inv_mass = known->random.bodies[network->bomb].inv_mass;
    network->gate = 0.01f;
    network->sweeps = AFTER;
    fill(network->low, (size_t)slot_network_inputs(network), -1e30f, -1e30f, seed);
    fill(network->high, (size_t)slot_network_inputs(network), 1e30f, 1e30f, seed);
    known->found = make_solution(&known->random.problem);
    known->expected = make_solution(&known->random.problem);
}

static void free_known(Known *known) {
    slot_network_destroy(known->network);
    free_solution(&known->found);
    free_solution(&known->expected);
}

static void solve_by_network(Known *known) {
    Error error = {0};
    ContactSolver solver;
    assert_ok(scene_net_make(&solver, known->network, &error), error);
    assert_ok(solver.kind->solve(solver.state, &known->random.problem, &known->found, &error), error);
    free_solver(&solver);
}

static void solve_by_momentum(Known *known) {
    Error error = {0};
    ContactSolver solver = make_solver(&solver_momentum, "k=20");
    assert_ok(solver.kind->solve(solver.state, &known->random.problem, &known->expected, &error), error);
    free_solver(&solver);
}

static bool same_bits(const Known *known) {
    return memcmp(known->found.velocities, known->expected.velocities,
                  (size_t)known->random.problem.body_count * sizeof *known->found.velocities) == 0;
}

static void assert_momentums_bits(Known *known, const char *what) {
    solve_by_network(known);
    solve_by_momentum(known);
    assert_same_bits(&known->random.problem, &known->found, &known->expected, what);
}

/* What a body gained is what the impulses, one way on a and the other way on b, gave it. Every visit rounds in the unit of
   the velocity that there is. */
static void assert_impulses_explain(const Known *known, double rounding) {
    const ContactProblem *problem = &known->random.problem;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        double x = (double)body->velocity.x, y = (double)body->velocity.y, most = 1 + hypot(x, y);
        for (int k = 0; k < problem->contact_count; k++) {
            const ContactPoint *contact = &problem->contacts[k];
            if (contact->a != i && contact->b != i) continue;
            const ContactImpulse p = known->found.impulses[k];
            const double sign = (contact->a == i ? -1 : 1) * (double)body->inv_mass;
            const double n[2] = {(double)contact->normal.x, (double)contact->normal.y};
            x += sign * ((double)p.normal * n[0] + (double)p.tangent * n[1]);
            y += sign * ((double)p.normal * n[1] - (double)p.tangent * n[0]);
            most += fabs(sign) * hypot((double)p.normal, (double)p.tangent);
        }
        assert_near(known->found.velocities[i].linear.x, x, rounding * most);
        assert_near(known->found.velocities[i].linear.y, y, rounding * most);
    }
}

static void momentum_and_cones_are_kept(void **state) {
    (void)state;
    static Known known;
    uint32_t seed = 3;
    int other = 0, outside = 0;
    for (int run = 0; run < RUNS; run++) {
        make_known(&known, &seed, run, 0.7f);
        if (run % 2 == 1)
            for (int s = 1; s < AFTER; s++) known.network->factors[s] = 0.5f;
        solve_by_network(&known);
        outside += known.found.fallbacks.outside_cone;
        assert_int_equal(known.found.fallbacks.not_finite, 0);
        solve_by_momentum(&known);
        other += !same_bits(&known);
        assert_impulses_explain(&known, 2e-5);
        for (int k = 0; k < known.random.problem.contact_count; k++) {
            const ContactImpulse p = known.found.impulses[k];
            assert_true(p.normal >= 0);
            assert_true(fabsf(p.tangent) <= known.random.contacts[k].friction * p.normal);
        }
        assert_true(known.found.momentum_error == 0);
        free_known(&known);
    }
    assert_true(other > RUNS / 2);
    assert_true(outside > RUNS);
}

static void assert_refused(Known *known, const char *text) {
    Error error = {0};
    ContactSolver solver;
    assert_ok(scene_net_make(&solver, known->network, &error), error);
    assert_false(solver.kind->solve(solver.state, &known->random.problem, &known->found, &error));
    assert_error(error, ERROR_INPUT, text);
    free_solver(&solver);
}

static void another_scene_is_refused(void **state) {
    (void)state;
    static Known known;
    char text[200];
    uint32_t seed = 5;
    make_known(&known, &seed, 7, 1);
    ContactProblem *problem = &known.random.problem;
    const int bomb = known.network->bomb, bodies = problem->body_count;
    problem->bomb = bomb == 0 ? 1 : 0;
    snprintf(text, sizeof text, "scene-net: error: the network is for the scene random, where the bomb is body %d",
             bomb);
    assert_refused(&known, text);
    problem->bomb = bomb;
    known.network->body_count = bodies + 1;
    snprintf(text, sizeof text, "scene random of %d bodies; this one has %d", bodies + 1, bodies);
    assert_refused(&known, text);
    known.network->body_count = bodies;
    /* Before the bomb comes there is one body less. */
    problem->bomb = -1;
    snprintf(text, sizeof text, "scene random of %d bodies; this one has %d", bodies - 1, bodies);
    assert_refused(&known, text);
    free_known(&known);
}

static void a_step_unlike_the_training_is_momentums(void **state) {
    (void)state;
    static Known known;
    uint32_t seed = 7;
    for (int run = 0; run < RUNS; run++) {
        make_known(&known, &seed, run, 0.7f);
        SlotNetwork *network = known.network;
        const int input = run % slot_network_inputs(network);
        network->bomb_inv_mass += 0.001f;
        assert_momentums_bits(&known, "another mass");
        assert_int_equal(known.found.fallbacks.beyond_training, 1);
        network->bomb_inv_mass -= 0.001f;
        network->bomb_inv_mass = known.random.bodies[network->bomb].inv_mass;
        network->high[input] = -1e29f;
        assert_momentums_bits(&known, "an input too high");
        assert_int_equal(known.found.fallbacks.beyond_training, 1);
        network->high[input] = 1e30f;
        network->low[input] = 1e29f;
        assert_momentums_bits(&known, "an input too low");
        network->low[input] = -1e30f;
        known.random.bodies[network->bomb].position.x = NAN;
        assert_momentums_bits(&known, "a body nowhere");
        free_known(&known);
    }
}

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

/* One run of up to `most` sweeps, looked at every 8, while the gap is `near` or more. Returns how many times 8. */
static int go_on(Sweeps *sweeps, const ContactProblem *problem, float near, int most) {
    float factors[MORE];
    for (int s = 0; s < MORE; s++) factors[s] = momentum_factor_by_hand(s, MORE);
    int times = 0;
    for (; 8 * times < most && impact_gap_reaches(sweeps, problem->contact_count, near); times++)
        assert_true(times == 0 ? sweeps_run_momentum(sweeps, factors, 8)
                               : sweeps_continue_momentum(sweeps, factors + 8 * times, 8));
    return times;
}

static int sweep_from_the_warm_start(Known *known) {
    const ContactProblem *problem = &known->random.problem;
    const SlotNetwork *network = known->network;
    Sweeps sweeps = {0};
    assert_true(sweeps_begin_coloured(&sweeps, sweeps_best_kernel(), problem));
    assert_true(impact_gap_reaches(&sweeps, problem->contact_count, network->gate));
    assert_true(network->factors[1] > 0 ? sweeps_run_momentum(&sweeps, network->factors, AFTER)
                                        : sweeps_run(&sweeps, AFTER));
    const int times = go_on(&sweeps, problem, 0.1f, MORE);
    assert_true(sweeps_end(&sweeps, &known->expected));
    sweeps_free(&sweeps);
    return times;
}

/* But for the sign of a 0, to which nothing was added. */
static void assert_same_velocities(const Known *known) {
    for (int i = 0; i < known->random.problem.body_count; i++) {
        const BodyVelocity *found = &known->found.velocities[i], *expected = &known->expected.velocities[i];
        assert_true(found->linear.x == expected->linear.x && found->linear.y == expected->linear.y);
        assert_true(found->angular == expected->angular);
    }
}

/* 10 sweeps, and 8, 16 or 24 more while the gap is 0.015 m/s or more. */
static int sweep_calmly(Known *known) {
    const ContactProblem *problem = &known->random.problem;
    Sweeps sweeps = {0};
    float factors[REST / 2];
    for (int s = 0; s < REST / 2; s++) factors[s] = momentum_factor_by_hand(s, REST / 2);
    assert_true(sweeps_begin_coloured(&sweeps, sweeps_best_kernel(), problem));
    assert_true(sweeps_run_momentum(&sweeps, factors, REST / 2));
    const int times = go_on(&sweeps, problem, 0.1f * 0.15f, CALM_MORE);
    assert_true(sweeps_end(&sweeps, &known->expected));
    sweeps_free(&sweeps);
    return times;
}

static void a_calm_step_takes_half_the_sweeps(void **state) {
    (void)state;
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

static void a_network_that_says_nothing_changes_nothing(void **state) {
    (void)state;
    static Known known;
    uint32_t seed = 9;
    int more = 0, twice = 0;
    for (int run = 0; run < RUNS; run++) {
        make_known(&known, &seed, run, 0.7f);
        SlotNetwork *network = known.network;
        for (int i = 0; i < network->slot_count; i++) network->cap[i] = 1e6f;
        memset(network->rows, 0,
               (network->parameter_count - (size_t)(network->rows - network->parameters)) * sizeof(float));
        for (int s = 1; s < AFTER && run % 2 == 1; s++) network->factors[s] = 0.5f;
        slot_network_pack(network);
        calm(&known.random, run % 4 == 0 ? 0.01f : run % 4 == 1 ? 0.1f : 1);
        put_warm_impulses_into_the_cone(&known.random);
        network->gate = 0.7f * (float)gap_of(&known.random.problem);
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

/* Near the bound on what is pushed; random effective masses may add to it. */
static void assert_sane(const Known *known, double most) {
    for (int i = 0; i < known->random.problem.body_count; i++) {
        const BodyVelocity *v = &known->found.velocities[i];
        assert_near(v->linear.x, 0, most);
        assert_near(v->linear.y, 0, most);
        assert_near(v->angular, 0, most);
    }
    for (int k = 0; k < known->random.problem.contact_count; k++) {
        assert_true(isfinite(known->found.impulses[k].normal));
        assert_true(isfinite(known->found.impulses[k].tangent));
    }
}

static bool pushes_a_body(const RandomProblem *random) {
    bool pushes = false;
    for (int k = 0; k < random->problem.contact_count; k++)
        pushes |=
            random->bodies[random->contacts[k].a].inv_mass > 0 || random->bodies[random->contacts[k].b].inv_mass > 0;
    return pushes;
}

static void no_answer_throws_a_body_away(void **state) {
    (void)state;
    static const float wild[] = {NAN, INFINITY, -INFINITY, 1e30f, -1e30f, FLT_MAX, 1e12f, 1e7f};
    static Known known;
    uint32_t seed = 11;
    for (int run = 0; run < RUNS; run++)
        for (size_t w = 0; w < sizeof wild / sizeof wild[0]; w++) {
            make_known(&known, &seed, run % 20, 1);
            SlotNetwork *network = known.network;
            const int outputs = 2 * network->slot_count;
            for (int i = 0; i < outputs; i++)
                if (run % 3 == 0 || uniform(&seed, 0, 1) < 0.3f) network->biases[i] = wild[w];
            solve_by_network(&known);
            assert_sane(&known, 5e4);
            assert_impulses_explain(&known, 1e-3);
            solve_by_momentum(&known);
            if (run % 3 == 0 && wild[w] > 1 && pushes_a_body(&known.random)) {
                assert_true(same_bits(&known));
                assert_int_equal(known.found.fallbacks.not_finite, 1);
            }
            free_known(&known);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(momentum_and_cones_are_kept),
        cmocka_unit_test(another_scene_is_refused),
        cmocka_unit_test(a_step_unlike_the_training_is_momentums),
        cmocka_unit_test(a_calm_step_takes_half_the_sweeps),
        cmocka_unit_test(a_network_that_says_nothing_changes_nothing),
        cmocka_unit_test(no_answer_throws_a_body_away),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
