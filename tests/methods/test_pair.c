/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "methods/pair.h"

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

TEST(inputs_are_relative_position_velocities_spins_rotations) {
    float inputs[PAIR_INPUTS];
    const float expected[PAIR_INPUTS] = {0, 1, 3, -4, -1, -2, 5, -3, 0.25f, 0};
    pair_inputs(&problem, NULL, 2, PAIR_RELATIVE, inputs);
    for (int i = 0; i < PAIR_INPUTS; i++) assert_near(inputs[i], expected[i], 0);
}

TEST(views_show_what_they_are_named_for) {
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
    assert_true(pair_view_of_inputs(pair_views[PAIR_RAW].inputs, &view) && view == PAIR_RAW);
    assert_false(pair_view_of_inputs("", &view));
}

/* Up with 4 and 6, right with 1 and 1 (the tangent of an upward normal points right): P = (2, 10), about the box's
   centre -0.5 * 4 + 0.5 * 1 + 0.5 * 6 + 0.5 * 1 = 2. */
TEST(changes_are_those_of_the_pairs_own_impulses) {
    ContactImpulse impulses[3] = {{4, 1}, {6, 1}, {1000, 1000}};
    const ContactSolution solution = {NULL, impulses, 0, {0}};
    float changes[PAIR_CHANGES];
    const float expected[PAIR_CHANGES] = {0, 0, 0, 1, 5, 4};
    assert_int_equal(pair_contact_count(&problem, 0), 2);
    pair_changes(&problem, &solution, 0, 2, changes);
    for (int i = 0; i < PAIR_CHANGES; i++) assert_near(changes[i], expected[i], 1e-6);
}

/* Between two bodies that move: equal and opposite momentum. */
TEST(changes_keep_the_pairs_momentum) {
    ContactImpulse impulses[3] = {{0, 0}, {0, 0}, {8, 2}};
    const ContactSolution solution = {NULL, impulses, 0, {0}};
    float c[PAIR_CHANGES];
    assert_int_equal(pair_contact_count(&problem, 2), 1);
    pair_changes(&problem, &solution, 2, 1, c);
    assert_near(c[0] / bodies[1].inv_mass + c[3] / bodies[2].inv_mass, 0, 1e-6);
    assert_near(c[1] / bodies[1].inv_mass + c[4] / bodies[2].inv_mass, 0, 1e-6);
    assert_near(c[4], 8, 1e-6);
}

/* Slanted: normal (0.6, 0.8), so the tangent is (0.8, -0.6). Masses 2 and 1: 1 N s makes 1.5 m/s. */
static const ProblemBody slanted_bodies[3] = {
    {.inv_mass = 0.5f, .inv_inertia = 3, .velocity = {0, 2}, .angular_velocity = 1},
    {.inv_mass = 1, .inv_inertia = 6, .velocity = {-1, 0.5f}, .angular_velocity = -2},
    {.inv_mass = 1, .inv_inertia = 6}};
static const ContactPoint slanted_contacts[3] = {
    {.a = 0,
     .b = 1,
     .normal = {0.6f, 0.8f},
     .arm_a = {0.5f, 0.25f},
     .arm_b = {-0.5f, -0.5f},
     .bias = 0.2f,
     .warm_normal = 3,
     .warm_tangent = 0.5f},
    {.a = 0, .b = 1, .normal = {0.6f, 0.8f}, .arm_a = {0, 1}, .arm_b = {1, 0}, .bias = 0.1f, .warm_normal = 1},
    {.a = 1, .b = 2, .normal = {0, 1}, .arm_a = {0.5f, 0}}};
static const ContactProblem slanted = {
    .body_count = 3, .contact_count = 3, .bodies = slanted_bodies, .contacts = slanted_contacts};

/* First point: b's moves with (-1, 0.5) + (-1, 1), a's with (1, 2) + (-0.75, 1.5), so (-2.25, -2) apart.
   Second point: (-1, 0.5) + (0, -2) and (1, 2) + (-3, 0): (1, -3.5). */
TEST(a_contact_is_seen_in_its_own_frame) {
    BodyVelocity velocities[3] = {{{1, 2}, 3}, {{-1, 0.5f}, -2}, {{0, 0}, 0}};
    ContactImpulse impulses[3] = {{4, -1}, {2, 0}, {0, 0}};
    const PairMoment now = {.velocities = velocities, .impulses = impulses};
    const float expected[20] = {-2.95f, -0.6f, 0.2f, 6, -1.5f, 0.5f,  0.25f, -0.7f, -0.1f,       -2.2f,
                                2.9f,   0.1f,  3,    0, 0.8f,  -0.6f, 0.6f,  0.8f,  1.0f / 3.0f, 1};
    float inputs[PAIR_INPUTS_MAX];
    pair_inputs(&slanted, &now, 0, PAIR_CONTACT, inputs);
    for (int i = 0; i < 20; i++) assert_near(inputs[i], expected[i], 1e-6);
    pair_inputs(&slanted, &now, 2, PAIR_CONTACT, inputs);
    for (int i = 9; i < 18; i++) assert_near(inputs[i], 0, 0); /* no second point */
    assert_near(inputs[18], 0.5, 1e-6);
    assert_near(inputs[19], 0, 0);
}

/* Body 1 is pushed by the third contact, alone: by (0, -7) N s at (0.5, 0). What has been done to body 0 is (1, 0) m/s,
   2 rad/s. */
TEST(neighbours_are_seen_in_the_contacts_frame) {
    BodyVelocity velocities[3] = {{{1, 2}, 3}, {{-1, 0.5f}, -2}, {{0, 0}, 0}};
    ContactImpulse impulses[3] = {{0, 0}}, alone[3] = {{0, 0}, {0, 0}, {7, 0}};
    BodyVelocity pushes[3] = {{{0, 0}, 0}, {{0, -7}, -6 * 0.5f * 7}, {{0, 7}, 0}};
    const PairMoment now = {.velocities = velocities, .impulses = impulses, .alone = alone, .pushes = pushes};
    const float expected[12] = {0, 0, 0, 0.8f * -7, -0.6f * -7, -21, 0.6f, 0.8f, 2, 0, 0, 0};
    float inputs[PAIR_INPUTS_MAX];
    pair_inputs(&slanted, &now, 0, PAIR_NEIGHBOURS, inputs);
    for (int i = 0; i < 12; i++) assert_near(inputs[20 + i], expected[i], 1e-5);
}

TEST(changes_are_turned_to_the_contacts_frame_and_back) {
    const float turned[PAIR_CHANGES] = {5, 0, 7, 0, 5, 8};
    float changes[PAIR_CHANGES] = {3, 4, 7, 4, -3, 8};
    pair_to_contact_frame(&slanted_contacts[0], changes);
    for (int i = 0; i < PAIR_CHANGES; i++) assert_near(changes[i], turned[i], 1e-6);
    pair_from_contact_frame(&slanted_contacts[0], changes);
    const float world[PAIR_CHANGES] = {3, 4, 7, 4, -3, 8};
    for (int i = 0; i < PAIR_CHANGES; i++) assert_near(changes[i], world[i], 1e-6);
}

/* (5 - 3, 1.5 - 0.5) and (0 - 1, 0) N s, as m/s; no second point: nothing. */
TEST(point_changes_go_beyond_the_warm_start) {
    ContactImpulse impulses[3] = {{5, 1.5f}, {0, 0}, {4, 2}};
    const float two[PAIR_POINT_CHANGES] = {3, 1.5f, -1.5f, 0}, one[PAIR_POINT_CHANGES] = {8, 4, 0, 0};
    float changes[PAIR_CHANGES];
    pair_point_changes(&slanted, impulses, 0, changes);
    for (int i = 0; i < PAIR_POINT_CHANGES; i++) assert_near(changes[i], two[i], 1e-6);
    const ContactSolution solution = {NULL, impulses, 0, {0}};
    pair_step_changes(&slanted, &solution, 2, PAIR_CONTACT, TARGET_POINTS, changes);
    for (int i = 0; i < PAIR_POINT_CHANGES; i++) assert_near(changes[i], one[i], 1e-6);
}

/* Of both bodies, whoever changed them; by the contact view along normal and tangent. */
TEST(net_changes_are_those_of_the_bodies) {
    BodyVelocity velocities[3] = {{{3, 6}, 3}, {{3, -2.5f}, -1}, {{0, 0}, 0}};
    const ContactSolution solution = {velocities, NULL, 0, {0}};
    const float world[PAIR_CHANGES] = {3, 4, 2, 4, -3, 1}, turned[PAIR_CHANGES] = {5, 0, 2, 0, 5, 1};
    float changes[PAIR_CHANGES];
    pair_step_changes(&slanted, &solution, 0, PAIR_RAW, TARGET_NET, changes);
    for (int i = 0; i < PAIR_CHANGES; i++) assert_near(changes[i], world[i], 1e-6);
    pair_step_changes(&slanted, &solution, 0, PAIR_CONTACT, TARGET_NET, changes);
    for (int i = 0; i < PAIR_CHANGES; i++) assert_near(changes[i], turned[i], 1e-6);
}

RUN_TESTS(NULL, NULL)
