/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "dynamics/pair.h"

/* A box of mass 2 and inertia 0.5 on a fixed body, touching in two points below it; a third contact with another. */
static const ProblemBody bodies[3] = {{.position = {0, -10}, .angle = 0.5f, .size = {100, 20}},
                                      {.position = {1, 0.5f},
                                       .angle = 0.25f,
                                       .size = {1, 1},
                                       .inv_mass = 0.5f,
                                       .inv_inertia = 2,
                                       .velocity = {3, -4},
                                       .angular_velocity = 5},
                                      {.position = {1, 1.5f},
                                       .size = {1, 1},
                                       .inv_mass = 1,
                                       .inv_inertia = 6,
                                       .velocity = {-1, -2},
                                       .angular_velocity = -3}};
static const ContactPoint contacts[3] = {
    {.a = 0, .b = 1, .normal = {0, 1}, .arm_b = {-0.5f, -0.5f}},
    {.a = 0, .b = 1, .normal = {0, 1}, .arm_b = {0.5f, -0.5f}},
    {.a = 1, .b = 2, .normal = {0, 1}, .arm_a = {0.5f, 0.5f}, .arm_b = {0.5f, -0.5f}}};
static const ContactProblem problem = {.body_count = 3, .contact_count = 3, .bodies = bodies, .contacts = contacts};

static void inputs_are_relative_position_velocities_spins_rotations(void **state) {
    (void)state;
    float inputs[PAIR_INPUTS];
    const float expected[PAIR_INPUTS] = {0, 1, 3, -4, -1, -2, 5, -3, 0.25f, 0};
    pair_inputs(&problem, NULL, 2, PAIR_RELATIVE, inputs);
    for (int i = 0; i < PAIR_INPUTS; i++) assert_near(inputs[i], expected[i], 0);
}

static void views_show_what_they_are_named_for(void **state) {
    (void)state;
    float inputs[PAIR_INPUTS_MAX];
    const float raw[] = {1, 0.5f, 1, 1.5f, 7, 8, -1, -2, 9, -3, 0.25f, 0};
    BodyVelocity velocities[3] = {{{0, 0}, 0}, {{7, 8}, 9}, {{-1, -2}, -3}};
    const PairMoment now = {.velocities = velocities};
    pair_inputs(&problem, &now, 2, PAIR_RAW, inputs);
    for (int i = 0; i < 12; i++) assert_near(inputs[i], raw[i], 0);
    inputs[10] = 77;
    pair_inputs(&problem, &now, 2, PAIR_RAW_UNTURNED, inputs);
    for (int i = 0; i < 10; i++) assert_near(inputs[i], raw[i], 0);
    assert_near(inputs[10], 77, 0);
    PairView view = PAIR_RELATIVE;
    assert_true(pair_view_find("raw-unturned", &view) && view == PAIR_RAW_UNTURNED);
    assert_true(pair_view_of_inputs(pair_views[PAIR_RAW].inputs, &view) && view == PAIR_RAW);
    assert_false(pair_view_find("raw ", &view));
    assert_false(pair_view_of_inputs("", &view));
}

/* Up with 4 and 6, right with 1 and 1 (the tangent of an upward normal points right): P = (2, 10), about the box's
   centre -0.5 * 4 + 0.5 * 1 + 0.5 * 6 + 0.5 * 1 = 2. */
static void changes_are_those_of_the_pairs_own_impulses(void **state) {
    (void)state;
    ContactImpulse impulses[3] = {{4, 1}, {6, 1}, {1000, 1000}};
    const ContactSolution solution = {NULL, impulses, 0};
    float changes[PAIR_CHANGES];
    const float expected[PAIR_CHANGES] = {0, 0, 0, 1, 5, 4};
    assert_int_equal(pair_contact_count(&problem, 0), 2);
    pair_changes(&problem, &solution, 0, 2, changes);
    for (int i = 0; i < PAIR_CHANGES; i++) assert_near(changes[i], expected[i], 1e-6);
}

/* Between two bodies that move: equal and opposite momentum. */
static void changes_keep_the_pairs_momentum(void **state) {
    (void)state;
    ContactImpulse impulses[3] = {{0, 0}, {0, 0}, {8, 2}};
    const ContactSolution solution = {NULL, impulses, 0};
    float c[PAIR_CHANGES];
    assert_int_equal(pair_contact_count(&problem, 2), 1);
    pair_changes(&problem, &solution, 2, 1, c);
    assert_near(c[0] / bodies[1].inv_mass + c[3] / bodies[2].inv_mass, 0, 1e-6);
    assert_near(c[1] / bodies[1].inv_mass + c[4] / bodies[2].inv_mass, 0, 1e-6);
    assert_near(c[4], 8, 1e-6);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(inputs_are_relative_position_velocities_spins_rotations),
                                       cmocka_unit_test(views_show_what_they_are_named_for),
                                       cmocka_unit_test(changes_are_those_of_the_pairs_own_impulses),
                                       cmocka_unit_test(changes_keep_the_pairs_momentum)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
