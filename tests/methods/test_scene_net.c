/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method scene-net with random networks on random problems: what it keeps whatever the network says, and where the
   network has no say. */
#include "consistent.h"
#include "known.h"

#include <float.h>

/* What impulses make of a body, and m/s, the sum of all that was done to it. */
typedef struct Gained {
    double x, y, most;
} Gained;

static Gained gained_by(const Known *known, int i) {
    const ContactProblem *problem = &known->random.problem;
    const ProblemBody *body = &problem->bodies[i];
    Gained gained = {(double)body->velocity.x, (double)body->velocity.y, 0};
    gained.most = 1 + hypot(gained.x, gained.y);
    for (int k = 0; k < problem->contact_count; k++) {
        const ContactPoint *contact = &problem->contacts[k];
        if (contact->a != i && contact->b != i) continue;
        const ContactImpulse p = known->found.impulses[k];
        const double sign = (contact->a == i ? -1 : 1) * (double)body->inv_mass;
        const double n[2] = {(double)contact->normal.x, (double)contact->normal.y};
        gained.x += sign * ((double)p.normal * n[0] + (double)p.tangent * n[1]);
        gained.y += sign * ((double)p.normal * n[1] - (double)p.tangent * n[0]);
        gained.most += fabs(sign) * hypot((double)p.normal, (double)p.tangent);
    }
    return gained;
}

/* What a body gained is what the impulses, one way on a and the other way on b, gave it. Every visit rounds in the unit
   of the velocities that there are, which are its neighbours', too: sweeps need not converge on random effective
   masses. */
static void assert_impulses_explain(const Known *known, double rounding) {
    double most = 0;
    for (int i = 0; i < known->random.problem.body_count; i++) most = fmax(most, gained_by(known, i).most);
    for (int i = 0; i < known->random.problem.body_count; i++) {
        const Gained gained = gained_by(known, i);
        assert_near(known->found.velocities[i].linear.x, gained.x, rounding * most);
        assert_near(known->found.velocities[i].linear.y, gained.y, rounding * most);
    }
}

TEST(momentum_and_cones_are_kept) {
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
        assert_in_cone(&known.random.problem, known.found.impulses);
        assert_true(known.found.momentum_error == 0);
        free_known(&known);
    }
    assert_true(other > RUNS / 2);
    assert_true(outside > RUNS);
}

static void refuse(Known *known, const char *text) {
    Error error = {0};
    OWN(ContactSolver) solver;
    assert_ok(scene_net_make(&solver, known->network, near_aim, &error), error);
    assert_refused(solver.kind->solve(solver.state, &known->random.problem, &known->found, &error), text);
}

TEST(another_scene_is_refused) {
    static Known known;
    char text[200];
    uint32_t seed = 5;
    make_known(&known, &seed, 7, 1);
    ContactProblem *problem = &known.random.problem;
    const int bomb = known.network->bomb, bodies = problem->body_count;
    problem->bomb = bomb == 0 ? 1 : 0;
    snprintf(text, sizeof text, "scene-net: error: the network is for the scene random, with the bomb as body %d",
             bomb);
    refuse(&known, text);
    problem->bomb = bomb;
    known.network->body_count = bodies + 1;
    snprintf(text, sizeof text, "scene random of %d bodies; this one has %d", bodies + 1, bodies);
    refuse(&known, text);
    known.network->body_count = bodies;
    /* Before the bomb comes there is one body less. */
    problem->bomb = -1;
    snprintf(text, sizeof text, "scene random of %d bodies; this one has %d", bodies - 1, bodies);
    refuse(&known, text);
    free_known(&known);
}

TEST(a_step_unlike_the_training_is_momentums) {
    static Known known;
    uint32_t seed = 7;
    for (int run = 0; run < RUNS; run++) {
        make_known(&known, &seed, run, 0.7f);
        SceneNet *network = known.network;
        const int input = run % scene_net_inputs(network);
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

TEST(no_answer_throws_a_body_away) {
    static const float wild[] = {NAN, INFINITY, -INFINITY, 1e30f, -1e30f, FLT_MAX, 1e12f, 1e7f};
    static Known known;
    uint32_t seed = 11;
    for (int run = 0; run < RUNS; run++)
        for (size_t w = 0; w < sizeof wild / sizeof wild[0]; w++) {
            make_known(&known, &seed, run % 20, 1);
            SceneNet *network = known.network;
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

/* A bomb between two walls, pushed by both alike: nothing is left of that, nor of its own speed, which was rounded
   away. */
TEST(pushes_that_cancel_are_no_answer) {
    static Known known;
    static const Slot slots[] = {{0, 1, 0}, {1, 2, 1}};
    static const SceneNetShape shape = {3, 1, 2, 16, 16, 16, 16};
    uint32_t seed = 12;
    make_random(&known.random, &seed, 3, 0, 1);
    for (int i = 0; i < 3; i++) known.random.bodies[i] = (ProblemBody){.inv_mass = i == 1, .inv_inertia = i == 1};
    known.random.bodies[1].velocity = vec2(3, 1);
    for (int k = 0; k < 2; k++)
        known.random.contacts[k] = (ContactPoint){
            .a = k, .b = k + 1, .normal = {1, 0}, .mass_normal = 1, .mass_tangent = 1, .feature = (uint32_t)k};
    known.random.problem.contact_count = 2;
    known.random.problem.bomb = 1;
    known.network = make_scene_net(&shape, slots, &seed);
    let_know(&known);
    known.network->biases[0] = known.network->biases[2] = 1e9f;
    known.network->scale[0] = known.network->scale[1] = 1;
    assert_momentums_bits(&known, "pushes that cancel");
    assert_int_equal(known.found.fallbacks.not_finite, 1);
    known.network->biases[0] = known.network->biases[2] = 100;
    solve_by_network(&known);
    assert_int_equal(known.found.fallbacks.not_finite, 0);
    free_known(&known);
}

RUN_TESTS(NULL, NULL)
