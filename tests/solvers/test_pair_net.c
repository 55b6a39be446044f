/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "worlds.h"

#include "dynamics/pair.h"
#include "network/network.h"

/* A network of one linear layer that says the same whatever it sees, trained on data whose mean was twice that;
   written to a file, as the solver takes it. */
static const char *constant_network(int outputs, const float *values) {
    Error error = {0};
    const int widths[2] = {10, outputs};
    Network *network = network_create(1, widths, &error);
    assert_ok(network != NULL, error);
    strcpy(network->inputs, pair_views[PAIR_RELATIVE].inputs);
    for (int i = 0; i < outputs; i++) {
        network->biases[0][i] = values[i];
        network->output_mean[i] = 2 * values[i];
    }
    const char *path = temporary_path("constant.npz");
    assert_ok(network_write(network, path, &error), error);
    network_destroy(network);
    return path;
}

static ContactSolver make_network_solver(const ContactSolverKind *kind, const char *path) {
    Error error = {0};
    Settings settings = {0};
    assert_true(settings_default(&settings, "network", path));
    ContactSolver solver = {kind, kind->create(&settings, &error)};
    assert_ok(solver.state != NULL, error);
    return solver;
}

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

static void solve_by(const ContactSolverKind *kind, const char *path, const ProblemBody *with,
                     BodyVelocity velocities[3]) {
    ContactSolver solver = make_network_solver(kind, path);
    ContactProblem problem = {.body_count = 3, .contact_count = 2, .bomb = -1, .bodies = with, .contacts = contacts};
    ContactImpulse impulses[2];
    ContactSolution solution = {velocities, impulses, 0};
    Error error = {0};
    assert_ok(solver.kind->solve(solver.state, &problem, &solution, &error), error);
    free_solver(&solver);
}

static void solve(const char *path, const ProblemBody *with, BodyVelocity velocities[3]) {
    solve_by(&solver_pair_net, path, with, velocities);
}

/* The relative velocity changes by (3, 6): P = (3, 6) / (1/2 + 1) = (2, 4), in the middle of the contacts,
   (0.125, 0.5): from A's centre, and (-0.125, -0.5) from B's. */
static void two_outputs_act_as_one_impulse_in_the_middle(void **state) {
    (void)state;
    BodyVelocity v[3];
    solve(constant_network(2, (const float[]){3, 6}), bodies, v);
    assert_near(v[0].linear.x, 1 - 0.5 * 2, 1e-6);
    assert_near(v[0].linear.y, 2 - 0.5 * 4, 1e-6);
    assert_near(v[0].angular, 0.5 - 3 * (0.125 * 4 - 0.5 * 2), 1e-6);
    assert_near(v[1].linear.x, 2, 1e-6);
    assert_near(v[1].linear.y, -1 + 4, 1e-6);
    assert_near(v[1].angular, 6 * (-0.125 * 4 + 0.5 * 2), 1e-6);
    /* Momentum 2 (1, 2) + 1 (0, -1) = (2, 3), before and after. */
    assert_near(2 * v[0].linear.x + v[1].linear.x, 2, 1e-5);
    assert_near(2 * v[0].linear.y + v[1].linear.y, 3, 1e-5);
}

static void the_constant_says_what_the_data_were_on_average(void **state) {
    (void)state;
    BodyVelocity constant[3], network[3];
    solve_by(&solver_constant, constant_network(6, (const float[]){1, 2, 3, 4, 5, 6}), bodies, constant);
    solve(constant_network(6, (const float[]){2, 4, 6, 8, 10, 12}), bodies, network);
    assert_memory_equal(constant, network, sizeof constant);
}

static void six_outputs_are_added_as_they_are(void **state) {
    (void)state;
    BodyVelocity v[3];
    solve(constant_network(6, (const float[]){1, 2, 3, 4, 5, 6}), bodies, v);
    assert_near(v[0].linear.x, 2, 0);
    assert_near(v[0].linear.y, 4, 0);
    assert_near(v[0].angular, 3.5, 0);
    assert_near(v[1].linear.x, 4, 0);
    assert_near(v[1].linear.y, 4, 0);
    assert_near(v[1].angular, 6, 0);
    assert_near(v[2].linear.x, 0, 0);
}

static void a_fixed_body_is_not_moved(void **state) {
    (void)state;
    ProblemBody fixed[3];
    memcpy(fixed, bodies, sizeof fixed);
    fixed[0] = (ProblemBody){.position = {0, 0}, .size = {1, 1}};
    BodyVelocity v[3];
    solve(constant_network(6, (const float[]){1, 2, 3, 4, 5, 6}), fixed, v);
    assert_near(v[0].linear.x, 0, 0);
    assert_near(v[0].angular, 0, 0);
    assert_near(v[1].angular, 6, 0);
    solve(constant_network(2, (const float[]){3, 6}), fixed, v);
    assert_near(v[0].linear.y, 0, 0);
    assert_near(v[1].linear.y, -1 + 6, 1e-6);
}

/* A velocity so large that the network's sum overflows: the pair keeps its velocities. */
static void what_is_not_finite_never_reaches_a_body(void **state) {
    (void)state;
    Error error = {0};
    const int widths[2] = {10, 2};
    Network *network = network_create(1, widths, &error);
    assert_ok(network != NULL, error);
    strcpy(network->inputs, pair_views[PAIR_RELATIVE].inputs);
    for (int i = 0; i < 20; i++) network->weights[0][i] = 1e30f;
    const char *path = temporary_path("large.npz");
    assert_ok(network_write(network, path, &error), error);
    network_destroy(network);
    ProblemBody fast[3];
    memcpy(fast, bodies, sizeof fast);
    fast[1].velocity.x = 1e20f;
    BodyVelocity v[3];
    solve(path, fast, v);
    assert_near(v[0].linear.x, 1, 0);
    assert_near(v[1].linear.x, 1e20f, 0);
}

/* A network that tells pairs, inputs and outputs apart: three pairs of one batch, each added as its own prediction. */
static void every_pair_gets_its_own_prediction(void **state) {
    (void)state;
    Error error = {0};
    Network *network = network_create(1, (const int[]){PAIR_INPUTS, PAIR_CHANGES}, &error);
    assert_ok(network != NULL, error);
    strcpy(network->inputs, pair_views[PAIR_RELATIVE].inputs);
    for (int i = 0; i < PAIR_INPUTS * PAIR_CHANGES; i++) network->weights[0][i] = (float)(i * i % 17) / 16 - 0.4f;
    const char *path = temporary_path("different.npz");
    assert_ok(network_write(network, path, &error), error);
    ProblemBody three[3];
    memcpy(three, bodies, sizeof three);
    three[2].inv_mass = 1, three[2].velocity = vec2(-3, 0.5f), three[2].angle = 0.7f;
    const ContactPoint touching[3] = {{.a = 0, .b = 1}, {.a = 0, .b = 2}, {.a = 1, .b = 2}};
    const ContactProblem problem = {
        .body_count = 3, .contact_count = 3, .bomb = -1, .bodies = three, .contacts = touching};
    BodyVelocity expected[3], found[3];
    for (int i = 0; i < 3; i++) expected[i] = (BodyVelocity){three[i].velocity, three[i].angular_velocity};
    for (int p = 0; p < 3; p++) {
        float inputs[PAIR_INPUTS], changes[PAIR_CHANGES], scratch[2 * PAIR_INPUTS];
        pair_inputs(&problem, NULL, p, PAIR_RELATIVE, inputs);
        network_predict(network, inputs, scratch, changes);
        for (int side = 0; side < 2; side++) {
            BodyVelocity *body = &expected[side == 0 ? touching[p].a : touching[p].b];
            body->linear = vec2_add(body->linear, vec2(changes[3 * side], changes[3 * side + 1]));
            body->angular += changes[3 * side + 2];
        }
    }
    ContactSolver solver = make_network_solver(&solver_pair_net, path);
    ContactSolution solution = {found, (ContactImpulse[3]){{0}}, 0};
    assert_ok(solver.kind->solve(solver.state, &problem, &solution, &error), error);
    assert_memory_equal(found, expected, sizeof found);
    free_solver(&solver);
    network_destroy(network);
}

/* A network knows how it was trained to see a pair. */
static void a_raw_network_sees_positions(void **state) {
    (void)state;
    Error error = {0};
    const int widths[2] = {12, 6};
    Network *network = network_create(1, widths, &error);
    assert_ok(network != NULL, error);
    strcpy(network->inputs, pair_views[PAIR_RAW].inputs);
    /* The change of a's velocity is b's position, that of b's a's. */
    network->weights[0][0 * 12 + 2] = network->weights[0][1 * 12 + 3] = 1;
    network->weights[0][3 * 12 + 0] = network->weights[0][4 * 12 + 1] = 1;
    const char *path = temporary_path("raw.npz");
    assert_ok(network_write(network, path, &error), error);
    network_destroy(network);
    BodyVelocity v[3];
    solve(path, bodies, v);
    assert_near(v[0].linear.x, 1 + 0.25, 1e-6);
    assert_near(v[0].linear.y, 2 + 1, 1e-6);
    assert_near(v[1].linear.x, 0, 1e-6);
    assert_near(v[1].linear.y, -1, 1e-6);
}

static void a_network_of_another_shape_is_refused(void **state) {
    (void)state;
    Error error = {0};
    const int widths[2] = {10, 3};
    Network *network = network_create(1, widths, &error);
    assert_ok(network != NULL, error);
    strcpy(network->inputs, pair_views[PAIR_RELATIVE].inputs);
    const char *path = temporary_path("three.npz");
    assert_ok(network_write(network, path, &error), error);
    network_destroy(network);
    Settings settings = {0};
    assert_true(settings_default(&settings, "network", path));
    assert_null(solver_pair_net.create(&settings, &error));
    assert_error(error, ERROR_INPUT, "three.npz: error: a network with 10 inputs (dx dy ");

    error = (Error){0};
    assert_null(solver_pair_net.create(&(Settings){0}, &error));
    assert_error(error, ERROR_INPUT, "the scene names no network");
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(two_outputs_act_as_one_impulse_in_the_middle),
                                       cmocka_unit_test(the_constant_says_what_the_data_were_on_average),
                                       cmocka_unit_test(six_outputs_are_added_as_they_are),
                                       cmocka_unit_test(a_fixed_body_is_not_moved),
                                       cmocka_unit_test(what_is_not_finite_never_reaches_a_body),
                                       cmocka_unit_test(every_pair_gets_its_own_prediction),
                                       cmocka_unit_test(a_raw_network_sees_positions),
                                       cmocka_unit_test(a_network_of_another_shape_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
