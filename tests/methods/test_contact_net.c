/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The laws of pushing by impulses, for networks and problems that are as they like. */
#include "pair_networks.h"
#include "random_problem.h"

#include "nets/networks.h"
#include "methods/sweeps.h"

/* A network of two layers whose weights know nothing. */
static const char *random_network(PairView view, uint32_t seed) {
    const int widths[3] = {pair_views[view].count, 8, PAIR_POINT_CHANGES};
    Network *network = network_sized(2, widths);
    network->activations[0] = ACTIVATION_TANH;
    for (int i = 0; i < network_parameter_count(network); i++) network->weights[0][i] = 3 * (float)next_number(&seed);
    strcpy(network->inputs, pair_views[view].inputs);
    strcpy(network->outputs, pair_output_names(view, TARGET_POINTS, PAIR_POINT_CHANGES));
    strcpy(network->target, "points");
    return write_pair_network(network);
}

/* Moving bodies somewhere, with the arms of points that are in one place as seen from both. */
static void place_bodies(RandomProblem *random, uint32_t *seed) {
    for (int i = 0; i < random->problem.body_count; i++) {
        ProblemBody *body = &random->bodies[i];
        if (body->inv_mass == 0) body->inv_mass = 1, body->inv_inertia = 6;
        body->position = any_vector(seed, 3);
    }
    for (int i = 0; i < random->problem.contact_count; i++) {
        ContactPoint *contact = &random->contacts[i];
        contact->position = any_vector(seed, 3);
        contact->arm_a = vec2_sub(contact->position, random->bodies[contact->a].position);
        contact->arm_b = vec2_sub(contact->position, random->bodies[contact->b].position);
    }
}

/* What all bodies together have gained, and the sum of the sizes of what each did. */
typedef struct Gain {
    double x, y, turn, sizes;
} Gain;

static Gain gain(const RandomProblem *random, const BodyVelocity *after) {
    Gain sum = {0};
    for (int i = 0; i < random->problem.body_count; i++) {
        const ProblemBody *body = &random->bodies[i];
        const double mass = 1.0 / body->inv_mass, inertia = 1.0 / body->inv_inertia;
        const double x = mass * ((double)after[i].linear.x - body->velocity.x);
        const double y = mass * ((double)after[i].linear.y - body->velocity.y);
        const double turn = inertia * ((double)after[i].angular - body->angular_velocity);
        sum.x += x;
        sum.y += y;
        sum.turn += turn + body->position.x * y - body->position.y * x;
        sum.sizes += fabs(x) + fabs(y) + fabs(turn) + fabs(body->position.x * y) + fabs(body->position.y * x) +
                     mass * (fabs(body->velocity.x) + fabs(body->velocity.y)) + inertia * fabs(body->angular_velocity);
    }
    return sum;
}

/* Linear and angular, to the rounding of the velocities. */
TEST(momentum_is_kept) {
    uint32_t seed = 5;
    static RandomProblem random;
    for (int round = 0; round < 20; round++) {
        make_random(&random, &seed, 2 + round, 0.3f, 1);
        place_bodies(&random, &seed);
        BodyVelocity v[BODIES_MAX];
        ContactImpulse impulses[CONTACTS_MAX];
        const char *path = random_network(round % 2 ? PAIR_CONTACT : PAIR_NEIGHBOURS, seed);
        assert_near(solve_by(&solver_contact_net, path, 1, &random.problem, v, impulses), 0, 0);
        const Gain sum = gain(&random, v);
        assert_near(sum.x, 0, 1e-6 * sum.sizes);
        assert_near(sum.y, 0, 1e-6 * sum.sizes);
        assert_near(sum.turn, 0, 1e-6 * sum.sizes);
    }
}

/* Impulses push and stay in the cone, for warm starts outside it too; and they are what moved the bodies. */
TEST(impulses_stay_in_their_cones) {
    uint32_t seed = 6;
    static RandomProblem random;
    int pushed = 0, sliding = 0;
    for (int round = 0; round < 20; round++) {
        make_random(&random, &seed, 12, 0.3f, 1);
        BodyVelocity v[BODIES_MAX], expected[BODIES_MAX];
        ContactImpulse impulses[CONTACTS_MAX];
        solve_by(&solver_contact_net, random_network(round % 2 ? PAIR_CONTACT : PAIR_NEIGHBOURS, seed), 1,
                 &random.problem, v, impulses);
        for (int i = 0; i < random.problem.contact_count; i++) {
            ContactPoint *contact = &random.contacts[i];
            const float most = contact->friction * impulses[i].normal;
            assert_true(impulses[i].normal >= 0 && fabsf(impulses[i].tangent) <= most);
            pushed += impulses[i].normal > 0;
            sliding += most > 0 && fabsf(impulses[i].tangent) == most;
            contact->warm_normal = impulses[i].normal;
            contact->warm_tangent = impulses[i].tangent;
        }
        ContactSolution warm = {expected, impulses, 0, {0}};
        sequential_impulses_begin(&random.problem, &(SequentialOptions){true, true}, &warm);
        assert_velocities(v, expected, random.problem.body_count, 0);
    }
    assert_true(pushed > 100 && sliding > 50);
}

/* To the last bit, where the warm start is in its cones. */
TEST(a_network_of_zeros_is_the_warm_start) {
    uint32_t seed = 7;
    static RandomProblem random;
    const float zeros[PAIR_POINT_CHANGES] = {0};
    for (int round = 0; round < 5; round++) {
        make_random(&random, &seed, 12, 0.3f, 1);
        for (int i = 0; i < random.problem.contact_count; i++)
            random.contacts[i].warm_tangent =
                uniform(&seed, -1, 1) * random.contacts[i].friction * random.contacts[i].warm_normal;
        BodyVelocity v[BODIES_MAX], expected[BODIES_MAX];
        ContactImpulse impulses[CONTACTS_MAX], started[CONTACTS_MAX];
        solve_by(&solver_contact_net, constant_network(PAIR_CONTACT, TARGET_POINTS, 4, zeros), 1, &random.problem, v,
                 impulses);
        ContactSolution warm = {expected, started, 0, {0}};
        sequential_impulses_begin(&random.problem, &(SequentialOptions){true, true}, &warm);
        for (int i = 0; i < random.problem.contact_count; i++) {
            assert_near(impulses[i].normal, started[i].normal, 0);
            assert_near(impulses[i].tangent, started[i].tangent, 0);
        }
        assert_velocities(v, expected, random.problem.body_count, 0);
    }
}

/* Masses 2 and 1, so that 1 N s makes 1.5 m/s, of which the network asks 3 and -9; 6 and 0. */
static const ProblemBody bodies[2] = {{.inv_mass = 0.5f, .inv_inertia = 3}, {.inv_mass = 1, .inv_inertia = 6}};
static const ContactPoint contacts[2] = {{.a = 0,
                                          .b = 1,
                                          .normal = {0, 1},
                                          .arm_a = {-0.5f, 0.5f},
                                          .arm_b = {-0.5f, -0.5f},
                                          .friction = 0.25f,
                                          .warm_normal = 2,
                                          .warm_tangent = 0.5f},
                                         {.a = 0,
                                          .b = 1,
                                          .normal = {0, 1},
                                          .arm_a = {0.5f, 0.5f},
                                          .arm_b = {0.5f, -0.5f},
                                          .friction = 0.25f,
                                          .warm_normal = 1,
                                          .warm_tangent = 0.75f}};
static const float asked[PAIR_POINT_CHANGES] = {3, -9, 6, 0};

/* 2 + 3 / 1.5 = 4 along the normal; 0.5 - 9 / 1.5 beyond the cone, whose side is at 0.25 * 4; then 5 and 0.75. */
TEST(predictions_go_beyond_the_warm_start_into_the_cone) {
    const ContactProblem problem = {
        .body_count = 2, .contact_count = 2, .bomb = -1, .bodies = bodies, .contacts = contacts};
    BodyVelocity v[2];
    ContactImpulse impulses[2];
    const ContactSolution solution = solution_by(
        &solver_contact_net, constant_network(PAIR_CONTACT, TARGET_POINTS, 4, asked), 1, &problem, v, impulses);
    assert_fallbacks(&solution, 0, 1, 0);
    assert_near(impulses[0].normal, 4, 1e-6);
    assert_near(impulses[0].tangent, -1, 1e-6);
    assert_near(impulses[1].normal, 5, 1e-6);
    assert_near(impulses[1].tangent, 0.75, 1e-6);
    /* The tangent of an upward normal points right: P = (-0.25, 9), which turns b by 0.5 (5 - 4) + 0.5 (-0.25). */
    assert_near(v[0].linear.x, 0.5 * 0.25, 1e-6);
    assert_near(v[0].linear.y, -0.5 * 9, 1e-6);
    assert_velocity(v[1], -0.25, 9, 6 * (0.5 * (5 - 4) + 0.5 * -0.25), 1e-6);
}

/* Of one point, only the first two numbers count. */
TEST(a_missing_second_point_gets_nothing) {
    const ContactProblem problem = {
        .body_count = 2, .contact_count = 1, .bomb = -1, .bodies = bodies, .contacts = contacts};
    BodyVelocity v[2];
    ContactImpulse impulses[2] = {{0, 0}, {77, 77}};
    solve_by(&solver_contact_net, constant_network(PAIR_CONTACT, TARGET_POINTS, 4, asked), 1, &problem, v, impulses);
    assert_near(v[1].linear.y, 4, 1e-6);
    assert_near(v[1].linear.x, -1, 1e-6);
    assert_near(impulses[1].normal, 77, 0);
}

/* The first point's numbers overflow; its warm start, outside the cone, is brought into it. The second's do not. */
TEST(what_is_not_finite_leaves_a_point_its_warm_start) {
    Network *network = make_pair_network(PAIR_CONTACT, TARGET_POINTS, PAIR_POINT_CHANGES);
    for (int i = 0; i < 20; i++) network->weights[0][i] = network->weights[0][20 + i] = 3e38f;
    network->biases[0][2] = 3;
    ContactPoint two[2] = {contacts[0], contacts[1]};
    two[0].warm_tangent = 5;
    ProblemBody fast[2] = {bodies[0], bodies[1]};
    fast[1].velocity = vec2(10, 10);
    const ContactProblem problem = {.body_count = 2, .contact_count = 2, .bomb = -1, .bodies = fast, .contacts = two};
    BodyVelocity v[2];
    ContactImpulse impulses[2];
    const ContactSolution solution =
        solution_by(&solver_contact_net, write_pair_network(network), 1, &problem, v, impulses);
    assert_fallbacks(&solution, 1, 1, 0);
    assert_near(impulses[0].normal, 2, 0);
    assert_near(impulses[0].tangent, 0.5, 0);
    assert_near(impulses[1].normal, 1 + 3 / 1.5, 1e-6);
    assert_true(isfinite(v[0].linear.x) && isfinite(v[1].angular));
}

/* A box that touches the ground for three steps, each of which asks for as much again. */
TEST(impulses_are_the_next_steps_warm_start) {
    OWN(World) *world = make_world();
    add_ground(world, 0.2f);
    add_box(world, 1, 0.2f, vec2(0, 0.4f));
    const float little[PAIR_POINT_CHANGES] = {0.02f, 0, 0.03f, 0};
    OWN(ContactSolver)
    solver = make_network_solver(&solver_contact_net, constant_network(PAIR_CONTACT, TARGET_POINTS, 4, little), 1);
    for (int i = 1; i <= 3; i++) {
        run(world, &solver, 1);
        assert_int_equal(world_problem(world)->contact_count, 2);
        assert_near(world_problem(world)->contacts[0].warm_normal, 0.02 * (i - 1), 1e-6);
        assert_near(world_solution(world)->impulses[0].normal, 0.02 * i, 1e-6);
        assert_near(world_solution(world)->impulses[1].normal, 0.03 * i, 1e-6);
    }
}

RUN_TESTS(NULL, NULL)
