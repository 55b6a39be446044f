/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The measure of accuracy, on cases whose value is known. */
#include "worlds.h"

#include "methods/sweeps.h"
#include "methods/reference.h"

enum { BODIES = 3 };

/* Ground, and two boxes which the impulses of the step have stopped: they came with 10 m/s and 1 m/s. */
static const ProblemBody bodies[BODIES] = {{.size = {9, 9}},
                                           {.inv_mass = 1, .inv_inertia = 6, .velocity = {10, 0}},
                                           {.inv_mass = 0.5f, .inv_inertia = 3, .velocity = {0, 1}}};
static const ContactProblem problem = {.body_count = BODIES, .bomb = -1, .dt = 0.1f, .bodies = bodies};
static const ReferenceVelocity reference[BODIES] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

static SolutionError error_of(BodyVelocity first, BodyVelocity second) {
    const BodyVelocity velocities[BODIES] = {{{100, 100}, 100}, first, second};
    return solution_error(&problem, velocities, reference);
}

TEST(the_reference_itself_has_no_error) {
    SolutionError found = error_of((BodyVelocity){0}, (BodyVelocity){0});
    assert_true(found.rms == 0);
    assert_int_equal(found.right, 2);
    assert_int_equal(found.counted, 2);
}

/* sqrt((3^2 + 4^2 + 6^2/6 + 1^2 + 2^2) / 2) = sqrt(18) */
TEST(the_rms_is_over_the_bodies_that_move) {
    SolutionError found = error_of((BodyVelocity){{3, -4}, 6}, (BodyVelocity){{1, 2}, 0});
    assert_near(found.rms, sqrt(18), 1e-15);
    assert_int_equal(found.right, 0);
    assert_int_equal(found.counted, 2);
}

/* By |dv|^2 + dspin^2 / 6: 36 / 6 is less than 7, and more than 5. Static bodies do not count; what is no number
   does. */
TEST(the_worst_body_has_the_largest_error) {
    const BodyVelocity spins = {{0, 0}, 6};
    assert_int_equal(error_of(spins, (BodyVelocity){{sqrtf(7), 0}, 0}).worst, 2);
    assert_int_equal(error_of(spins, (BodyVelocity){{0, sqrtf(5)}, 0}).worst, 1);
    assert_int_equal(error_of((BodyVelocity){{1e9f, 0}, 0}, (BodyVelocity){{NAN, 0}, 0}).worst, 2);
    const ContactProblem ground = {.body_count = 1, .bodies = bodies};
    assert_int_equal(solution_error(&ground, &(BodyVelocity){{1, 1}, 1}, reference).worst, -1);
}

/* 5% of the 10 m/s that the first lost is 0.5 m/s; the 5% of the second are less than the 0.05 m/s that every body may
   have. Half the spin counts. */
TEST(a_body_is_right_within_its_allowance) {
    assert_int_equal(error_of((BodyVelocity){{0.499f, 0}, 0}, (BodyVelocity){{0, 0.0499f}, 0}).right, 2);
    assert_int_equal(error_of((BodyVelocity){{0.501f, 0}, 0}, (BodyVelocity){{0, 0.0499f}, 0}).right, 1);
    assert_int_equal(error_of((BodyVelocity){{0.499f, 0}, 0}, (BodyVelocity){{0, 0.0501f}, 0}).right, 1);
    assert_int_equal(error_of((BodyVelocity){{0, 0}, 0.998f}, (BodyVelocity){{0, 0}, 0.0998f}).right, 2);
    assert_int_equal(error_of((BodyVelocity){{0, 0}, 1.002f}, (BodyVelocity){{0, 0}, 0.1002f}).right, 0);
    assert_int_equal(error_of((BodyVelocity){{0.3f, 0}, 0.79f}, (BodyVelocity){{0, 0}, 0}).right, 2);
    assert_int_equal(error_of((BodyVelocity){{0.3f, 0}, 0.81f}, (BodyVelocity){{0, 0}, 0}).right, 1);
}

TEST(what_is_no_number_is_wrong) {
    SolutionError found = error_of((BodyVelocity){{NAN, 0}, 0}, (BodyVelocity){0});
    assert_true(isinf(found.rms));
    assert_int_equal(found.right, 1);
}

TEST(nothing_that_moves_is_no_error) {
    const ContactProblem ground = {.body_count = 1, .bomb = -1, .dt = 0.1f, .bodies = bodies};
    SolutionError found = solution_error(&ground, &(BodyVelocity){{1, 1}, 1}, reference);
    assert_true(found.rms == 0);
    assert_int_equal(found.counted, 0);
}

RUN_TESTS(NULL, NULL)
