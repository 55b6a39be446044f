/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pair_networks.h"

/* A (mass 2, inertia 1/3) below B (mass 1), touching at B's lower corners and in nothing else. */
static const ProblemBody bodies[3] = {
    {.position = {0, 0},
     .size = {1, 1},
     .inv_mass = 0.5f,
     .inv_inertia = 3,
     .velocity = {1, 2},
     .angular_velocity = 0.5f},
    {.position = {0.25f, 1}, .size = {1, 1}, .inv_mass = 1, .inv_inertia = 6, .velocity = {0, -1}},
    {.position = {9, 9}, .size = {1, 1}, .velocity = {0, 0}}};
static const ContactPoint contacts[2] = {
    {.a = 0, .b = 1, .position = {-0.25f, 0.5f}, .normal = {0, 1}, .arm_a = {-0.25f, 0.5f}, .arm_b = {-0.5f, -0.5f}},
    {.a = 0, .b = 1, .position = {0.5f, 0.5f}, .normal = {0, 1}, .arm_a = {0.5f, 0.5f}, .arm_b = {0.25f, -0.5f}}};

static ContactProblem touching(const ProblemBody *with) {
    return (ContactProblem){.body_count = 3, .contact_count = 2, .bomb = -1, .bodies = with, .contacts = contacts};
}

/* Returns the momentum made from nothing. */
static float solve(const char *path, const ProblemBody *with, BodyVelocity velocities[3]) {
    ContactImpulse impulses[2];
    const ContactProblem problem = touching(with);
    float made = solve_by(&solver_pair_net, path, 1, &problem, velocities, impulses);
    for (int i = 0; i < 2; i++) assert_true(impulses[i].normal == 0 && impulses[i].tangent == 0);
    return made;
}

static const char *pair_constant(int outputs, const float *values) {
    return constant_network(PAIR_RELATIVE, TARGET_PAIR, outputs, values);
}

/* The relative velocity changes by (3, 6): P = (3, 6) / (1/2 + 1) = (2, 4), in the middle of the contacts,
   (0.125, 0.5): from A's centre, and (-0.125, -0.5) from B's. */
TEST(two_outputs_act_as_one_impulse_in_the_middle) {
    BodyVelocity v[3];
    assert_near(solve(pair_constant(2, (const float[]){3, 6}), bodies, v), 0, 0);
    assert_velocity(v[0], 1 - 0.5 * 2, 2 - 0.5 * 4, 0.5 - 3 * (0.125 * 4 - 0.5 * 2), 1e-6);
    assert_velocity(v[1], 2, -1 + 4, 6 * (-0.125 * 4 + 0.5 * 2), 1e-6);
    /* Momentum 2 (1, 2) + 1 (0, -1) = (2, 3), before and after. */
    assert_near(2 * v[0].linear.x + v[1].linear.x, 2, 1e-5);
    assert_near(2 * v[0].linear.y + v[1].linear.y, 3, 1e-5);
}

/* Their momentum is 2 (1, 2) + 1 (4, 5) = (6, 9). */
TEST(six_outputs_are_added_as_they_are) {
    BodyVelocity v[3];
    assert_near(solve(pair_constant(6, six), bodies, v), sqrt(6 * 6 + 9 * 9), 1e-5);
    assert_velocity(v[0], 2, 4, 3.5, 0);
    assert_velocity(v[1], 4, 4, 6, 0);
    assert_near(v[2].linear.x, 0, 0);
}

TEST(a_fixed_body_is_not_moved) {
    ProblemBody fixed[3];
    memcpy(fixed, bodies, sizeof fixed);
    fixed[0] = (ProblemBody){.position = {0, 0}, .size = {1, 1}};
    BodyVelocity v[3];
    assert_near(solve(pair_constant(6, six), fixed, v), 0, 0); /* the ground takes what it is given */
    assert_near(v[0].linear.x, 0, 0);
    assert_near(v[0].angular, 0, 0);
    assert_near(v[1].angular, 6, 0);
    solve(pair_constant(2, (const float[]){3, 6}), fixed, v);
    assert_near(v[0].linear.y, 0, 0);
    assert_near(v[1].linear.y, -1 + 6, 1e-6);
}

/* By a contact along (0.6, 0.8), tangent (0.8, -0.6): 5 along the normal is (3, 4), 5 along the tangent (4, -3). */
TEST(outputs_by_contact_are_turned_into_the_world) {
    BodyVelocity v[3];
    ContactImpulse impulses[1];
    const ContactPoint slanted = {.a = 0, .b = 1, .normal = {0.6f, 0.8f}, .position = {0.125f, 0.5f}};
    const ContactProblem problem = {
        .body_count = 3, .contact_count = 1, .bomb = -1, .bodies = bodies, .contacts = &slanted};
    solve_by(&solver_pair_net, constant_network(PAIR_CONTACT, TARGET_PAIR, 6, (const float[]){5, 0, 1, 0, 5, 2}), 1,
             &problem, v, impulses);
    assert_velocity(v[0], 1 + 3, 2 + 4, 0.5 + 1, 1e-6);
    assert_velocity(v[1], 0 + 4, -1 - 3, 2, 1e-6);
    /* Two outputs: the relative velocity changes by (3, 4), by the impulse (2, 8/3) through (0.125, 0.5). */
    solve_by(&solver_pair_net, constant_network(PAIR_NEIGHBOURS, TARGET_PAIR, 2, (const float[]){5, 0}), 1, &problem, v,
             impulses);
    assert_velocity(v[0], 1 - 0.5 * 2, 2 - 0.5 * 8 / 3, 0.5 - 3 * (0.125 * 8 / 3 - 0.5 * 2), 1e-6);
    assert_near(v[1].linear.x, 2, 1e-6);
    assert_near(v[1].linear.y, -1 + 8 / 3.0, 1e-6);
}

/* The middle body is b of one pair, where it gets (4, 5), 6, and a of the other, where it gets (1, 2), 3. The pairs
   make 2 (1, 2) + 1 (2, 2.5) = (4, 6.5), and 1 (0.5, 1) + 4 (4, 5) = (16.5, 21). */
TEST(a_net_change_is_the_mean_over_a_bodys_pairs) {
    BodyVelocity v[3];
    ContactImpulse impulses[2];
    float made =
        solve_by(&solver_pair_net, constant_network(PAIR_RELATIVE, TARGET_NET, 6, six), 1, &chain, v, impulses);
    assert_near(v[0].linear.x, 1 + 1, 1e-6);
    assert_near(v[0].angular, 3, 1e-6);
    assert_velocity(v[1], 2.5, 3.5, 4.5, 1e-6);
    assert_near(v[2].linear.y, 5, 1e-6);
    assert_near(v[2].angular, 6, 1e-6);
    assert_near(made, sqrt(4 * 4 + 6.5 * 6.5) + sqrt(16.5 * 16.5 + 21 * 21), 1e-4);
    /* Two outputs: 2 and 2.4 N s, of which the middle body gets half, so that 1 N s is lost and 1.2 N s are made. */
    made = solve_by(&solver_pair_net, constant_network(PAIR_RELATIVE, TARGET_NET, 2, (const float[]){0, 3}), 1, &chain,
                    v, impulses);
    assert_near(v[0].linear.y, -0.5 * 2, 1e-6);
    assert_near(v[1].linear.y, (2 - 2.4) / 2, 1e-6);
    assert_near(v[2].linear.y, 0.25 * 2.4, 1e-6);
    assert_near(made, 1 + 1.2, 1e-5);
}

/* b gets a's velocity: 1 in the first pair, then what the first pair made of it in the second. */
TEST(single_impulses_go_pair_by_pair_for_k_sweeps) {
    Network *network = make_pair_network(PAIR_RAW_UNTURNED, TARGET_IMPULSE, PAIR_CHANGES);
    network->weights[0][3 * 10 + 4] = 1; /* dvxb = vxa */
    const char *path = write_pair_network(network);
    BodyVelocity v[3];
    ContactImpulse impulses[2];
    solve_by(&solver_pair_net, path, 1, &chain, v, impulses);
    assert_near(v[1].linear.x, 1, 0);
    assert_near(v[2].linear.x, 1, 0);
    float made = solve_by(&solver_pair_net, path, 3, &chain, v, impulses);
    assert_near(v[0].linear.x, 1, 0);
    assert_near(v[1].linear.x, 3, 0);
    assert_near(v[2].linear.x, 1 + 2 + 3, 0);
    assert_near(v[1].linear.y, 0, 0); /* no warm start */
    assert_near(made, 3 * 1 + (1 + 2 + 3) * 4, 1e-5);
}

/* A velocity so large that the network's sum overflows, and changes that only the sum with it overflows: the pair keeps
   its velocities. */
TEST(what_is_not_finite_never_reaches_a_body) {
    ProblemBody fast[3];
    memcpy(fast, bodies, sizeof fast);
    fast[1].velocity.x = 3e38f;
    const float largest[PAIR_CHANGES] = {1, 1, 1, 1.5e38f, 1, 1};
    for (PairTarget target = TARGET_PAIR; target <= TARGET_IMPULSE; target++) {
        Network *network = make_pair_network(PAIR_RELATIVE, target, 2);
        for (int i = 0; i < 20; i++) network->weights[0][i] = 1e30f;
        BodyVelocity v[3];
        for (int i = 0; i < 2; i++) {
            assert_near(solve(i == 0 ? write_pair_network(network)
                                     : constant_network(PAIR_RELATIVE, target, PAIR_CHANGES, largest),
                              fast, v),
                        0, 0);
            assert_near(v[0].linear.x, 1, 0);
            assert_near(v[1].linear.x, 3e38f, 0);
        }
        const ContactProblem problem = touching(fast);
        const ContactSolution solution =
            solution_by(&solver_pair_net, constant_network(PAIR_RELATIVE, target, PAIR_CHANGES, largest), 3, &problem,
                        v, (ContactImpulse[2]){{0}});
        assert_fallbacks(&solution, target == TARGET_IMPULSE ? 3 : 1, 0, 0);
    }
}

/* A network that tells pairs, inputs and outputs apart: three pairs of one batch, each added as its own prediction. */
TEST(every_pair_gets_its_own_prediction) {
    Network *network = make_pair_network(PAIR_RELATIVE, TARGET_PAIR, PAIR_CHANGES);
    for (int i = 0; i < PAIR_INPUTS * PAIR_CHANGES; i++) network->weights[0][i] = (float)(i * i % 17) / 16 - 0.4f;
    OWN(Network) *kept = network_copy(network, &error);
    assert_ok(kept != NULL, error);
    const char *path = write_pair_network(network);
    ProblemBody three[3];
    memcpy(three, bodies, sizeof three);
    three[2].inv_mass = 1, three[2].velocity = vec2(-3, 0.5f), three[2].angle = 0.7f;
    const ContactPoint all[3] = {{.a = 0, .b = 1}, {.a = 0, .b = 2}, {.a = 1, .b = 2}};
    const ContactProblem problem = {.body_count = 3, .contact_count = 3, .bomb = -1, .bodies = three, .contacts = all};
    BodyVelocity expected[3], found[3];
    for (int i = 0; i < 3; i++) expected[i] = (BodyVelocity){three[i].velocity, three[i].angular_velocity};
    for (int p = 0; p < 3; p++) {
        float inputs[PAIR_INPUTS], changes[PAIR_CHANGES], scratch[2 * PAIR_INPUTS];
        pair_inputs(&problem, NULL, p, PAIR_RELATIVE, inputs);
        network_predict(kept, inputs, scratch, changes);
        for (int side = 0; side < 2; side++) {
            BodyVelocity *body = &expected[side == 0 ? all[p].a : all[p].b];
            body->linear = vec2_add(body->linear, vec2(changes[3 * side], changes[3 * side + 1]));
            body->angular += changes[3 * side + 2];
        }
    }
    solve_by(&solver_pair_net, path, 1, &problem, found, (ContactImpulse[3]){{0}});
    assert_memory_equal(found, expected, sizeof found);
}

/* Of view contact, after the warm start: the first input is then what that left of the approach. */
TEST(a_network_by_contact_sees_the_moment_after_the_warm_start) {
    Network *network = make_pair_network(PAIR_CONTACT, TARGET_PAIR, PAIR_CHANGES);
    network->weights[0][5 * 20 + 0] = 1; /* dwb = vn1 */
    const ContactPoint warm = {.a = 0, .b = 1, .normal = {0, 1}, .warm_normal = 4};
    const ContactProblem problem = {
        .body_count = 3, .contact_count = 1, .bomb = -1, .bodies = bodies, .contacts = &warm};
    BodyVelocity v[3];
    ContactImpulse impulses[1];
    solve_by(&solver_pair_net, write_pair_network(network), 1, &problem, v, impulses);
    assert_near(v[1].angular, -1 - 2 + 4 * 1.5, 1e-6); /* -1 - 2 m/s, and 4 N s on 2 kg and 1 kg */
    assert_near(v[1].linear.y, -1, 0);                 /* but it says changes from before the warm start */
}

TEST(nothing_touches_nothing_happens) {
    const ContactProblem apart = {.body_count = 3, .bomb = -1, .bodies = bodies};
    for (PairTarget target = TARGET_PAIR; target <= TARGET_IMPULSE; target++) {
        BodyVelocity v[3];
        ContactImpulse impulses[1];
        assert_near(solve_by(&solver_pair_net, constant_network(PAIR_RELATIVE, target, 6, six), 5, &apart, v, impulses),
                    0, 0);
        assert_near(v[0].linear.y, 2, 0);
    }
}

/* For who looks at the world after the step; the next begins with none. */
TEST(the_world_tells_what_momentum_a_step_made) {
    OWN(World) *world = make_world();
    for (int i = 0; i < 2; i++)
        add_body(world, &(BodyDef){.size = {1, 1}, .mass = 1, .position = {0, 0.9f * (float)i}});
    OWN(ContactSolver)
    network = make_network_solver(&solver_pair_net, pair_constant(6, six), 1), engine = make_engine("");
    run(world, &network, 1);
    assert_near(world_solution(world)->momentum_error, sqrt(5 * 5 + 7 * 7), 1e-5);
    run(world, &engine, 1);
    assert_near(world_solution(world)->momentum_error, 0, 0);
}

RUN_TESTS(NULL, NULL)
