/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "methods/pair.h"

/* A box of 4 kg on the ground with two points under it, then a bomb of 2 kg at one point of its side. */
static const ProblemBody bodies[] = {
    {.position = {0, -5}},
    {.position = {1, 0.5f}, .inv_mass = 0.25f, .inv_inertia = 1.5f, .velocity = {0.5f, -1}, .angular_velocity = 2},
    {.position = {2, 1}, .inv_mass = 0.5f, .inv_inertia = 3, .velocity = {-7, 0}, .angular_velocity = -4}};
static const ContactPoint contacts[] = {
    {.a = 0, .b = 1, .normal = {0, 1}, .arm_a = {0.5f, 5}, .arm_b = {-0.5f, -0.5f}, .friction = 0.2f},
    {.a = 0, .b = 1, .normal = {0, 1}, .arm_a = {2, 5}, .arm_b = {1, -0.5f}, .friction = 0.2f},
    {.a = 1, .b = 2, .normal = {0.6f, 0.8f}, .arm_a = {0.5f, 0.25f}, .arm_b = {-0.5f, -0.25f}, .friction = 0.7f}};
static const ContactProblem problem = {.body_count = 3, .contact_count = 3, .bodies = bodies, .contacts = contacts};

TEST(a_context_tells_bodies_and_the_middle_of_the_points) {
    static const float on_ground[PAIR_CONTEXT] = {0,     0,     0.25f, 1.5f, 0, 1,    0.2f, 1.25f, 5,
                                                  0.25f, -0.5f, 0,     0,    0, 0.5f, -1,   2};
    static const float struck[PAIR_CONTEXT] = {0.25f, 1.5f,   0.5f, 3,  0.6f, 0.8f, 0.7f, 0.5f, 0.25f,
                                               -0.5f, -0.25f, 0.5f, -1, 2,    -7,   0,    -4};
    float context[PAIR_CONTEXT];
    pair_context(&problem, 0, context);
    for (int i = 0; i < PAIR_CONTEXT; i++) assert_near(context[i], on_ground[i], 1e-7);
    assert_null(pair_context_fault(context));
    pair_context(&problem, 2, context);
    for (int i = 0; i < PAIR_CONTEXT; i++) assert_near(context[i], struck[i], 1e-7);
    assert_null(pair_context_fault(context));
}

static void check_fault(int place, float number, const char *fault) {
    float context[PAIR_CONTEXT];
    pair_context(&problem, 0, context);
    context[place] = number;
    assert_string_equal(pair_context_fault(context), fault);
}

TEST(what_no_pair_has_is_a_fault) {
    check_fault(CONTEXT_INV_MASS_A, -1, "an inverse mass or inertia below 0");
    check_fault(CONTEXT_INV_INERTIA_B, -1e-6f, "an inverse mass or inertia below 0");
    check_fault(CONTEXT_INV_MASS_B, 0, "two static bodies");
    check_fault(CONTEXT_NORMAL, 0.1f, "a normal whose length is not 1");
    check_fault(CONTEXT_NORMAL + 1, -3e38f, "a normal whose length is not 1");
    check_fault(CONTEXT_FRICTION, -0.1f, "friction below 0");
}

RUN_TESTS(NULL, NULL)
