/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The residual of problems whose velocities are known without computing. */
#include "residuals.h"
#include "kernels.h"
#include "random_problem.h"

#include "methods/solvers.h"

#include <math.h>

/* Two boxes side by side on the ground, two contacts each: the velocities of the boxes are those that the contacts have,
   but for their sign. */
typedef struct Boxes {
    ProblemBody bodies[3];
    ContactPoint contacts[4];
    ContactProblem problem;
} Boxes;

static void make_boxes(Boxes *boxes, float left, float right) {
    *boxes = (Boxes){.bodies = {{.size = {100, 20}}}};
    for (int i = 0; i < 2; i++) {
        boxes->bodies[1 + i] =
            (ProblemBody){.size = {1, 1}, .inv_mass = 0.5f, .inv_inertia = 3, .velocity = {7, i == 0 ? left : right}};
        for (int k = 0; k < 2; k++)
            boxes->contacts[2 * i + k] = (ContactPoint){.a = 0,
                                                        .b = 1 + i,
                                                        .normal = {0, 1},
                                                        .arm_b = {k == 0 ? -0.5f : 0.5f, -0.5f},
                                                        .mass_normal = 1,
                                                        .mass_tangent = 1,
                                                        .friction = 0.2f};
    }
    boxes->problem = (ContactProblem){.body_count = 3,
                                      .contact_count = 4,
                                      .marked = -1,
                                      .dt = world_dt,
                                      .bodies = boxes->bodies,
                                      .contacts = boxes->contacts};
}

/* Reached from below and missed from above, by every kernel, with a rounding between. */
static void assert_residual(const ContactProblem *problem, double residual) {
    for (SweepKernel kernel = 0; kernel < SWEEP_KERNELS; kernel++) {
        if (!sweeps_can(kernel)) continue;
        Sweeps sweeps = {0};
        assert_true(sweeps_begin(&sweeps, kernel, problem, true, 1));
        if (residual > 0) assert_true(residual_reaches(&sweeps, problem->contact_count, (float)(0.9999 * residual)));
        assert_false(residual_reaches(&sweeps, problem->contact_count, (float)(1.0001 * residual + 1e-5)));
        sweeps_free(&sweeps);
    }
    ContactSolution warm = make_solution(problem);
    sequential_impulses_begin(problem, &engine_options, &warm);
    if (residual > 0) assert_true(residual_reaches_scalar(problem, &warm, (float)(0.9999 * residual)));
    assert_false(residual_reaches_scalar(problem, &warm, (float)(1.0001 * residual + 1e-5)));
    free_solution(&warm);
}

static void the_residual_is_the_root_of_the_mean_square_over_contacts(void **state) {
    (void)state;
    Boxes boxes;
    make_boxes(&boxes, 0, 0);
    assert_residual(&boxes.problem, 0);
    make_boxes(&boxes, -3, -3);
    assert_residual(&boxes.problem, 3);
    make_boxes(&boxes, -3, 0);
    assert_residual(&boxes.problem, 3 / sqrt(2));
    make_boxes(&boxes, -3, -4);
    assert_residual(&boxes.problem, 5 / sqrt(2));
}

static void what_parts_unpushed_is_no_miss(void **state) {
    (void)state;
    Boxes boxes;
    make_boxes(&boxes, 5, -2);
    assert_residual(&boxes.problem, 2 / sqrt(2));
    /* One contact of the left box pushes along with 2 N s: it misses, the other one does not. */
    boxes.contacts[0].warm_normal = 2;
    boxes.bodies[1].velocity.y = 4;
    boxes.bodies[1].angular_velocity = 3 * 0.5f * 2;
    assert_residual(&boxes.problem, sqrt((5 * 5 + 2 * 2 + 2 * 2) / 4.0));
}

/* A warm impulse of m v, half by each contact, stops a box. */
static void the_residual_is_that_after_the_warm_start(void **state) {
    (void)state;
    Boxes boxes;
    make_boxes(&boxes, -3, 0);
    for (int k = 0; k < 2; k++) boxes.contacts[k].warm_normal = 3;
    assert_residual(&boxes.problem, 0);
    for (int k = 0; k < 2; k++) boxes.contacts[k].warm_normal = 2;
    assert_residual(&boxes.problem, 1 / sqrt(2));
}

static void the_residual_is_measured_from_the_bias(void **state) {
    (void)state;
    Boxes boxes;
    make_boxes(&boxes, -3, 0);
    for (int k = 0; k < 4; k++) boxes.contacts[k].bias = 0.5f;
    assert_residual(&boxes.problem, sqrt((3.5 * 3.5 + 0.5 * 0.5) / 2));
}

static void spin_counts_at_the_arm(void **state) {
    (void)state;
    Boxes boxes;
    make_boxes(&boxes, 0, 0);
    /* One corner goes down with half the spin, the other up. */
    boxes.bodies[2].angular_velocity = 8;
    assert_residual(&boxes.problem, sqrt(4 * 4 / 4.0));
}

static void random_problems_have_the_residual_of_the_definition(void **state) {
    (void)state;
    static RandomProblem random;
    uint32_t seed = 6;
    for (int run = 0; run < 50; run++) {
        make_random(&random, &seed, 2 + run, 0.3f, 1);
        assert_residual(&random.problem, residual_of(&random.problem));
    }
}

/* Sweeps bring it down, and a network that is asked afterwards sees it. */
static void sweeps_reduce_the_residual(void **state) {
    (void)state;
    Boxes boxes;
    Sweeps sweeps = {0};
    make_boxes(&boxes, -3, -4);
    assert_true(sweeps_begin(&sweeps, sweeps_best_kernel(), &boxes.problem, true, 1));
    assert_true(residual_reaches(&sweeps, 4, 3));
    assert_true(sweeps_run(&sweeps, 100));
    assert_false(residual_reaches(&sweeps, 4, 1e-3f));
    sweeps_free(&sweeps);
}

/* Between 0.9999 and 1.0001 of this. */
static void assert_with_friction(const ContactProblem *problem, double residual) {
    Sweeps sweeps = {0};
    assert_true(sweeps_begin(&sweeps, sweeps_best_kernel(), problem, true, 1));
    if (residual > 0)
        assert_true(residual_of_visits_reaches(&sweeps, problem->contact_count, (float)(0.9999 * residual)));
    assert_false(residual_of_visits_reaches(&sweeps, problem->contact_count, (float)(1.0001 * residual + 1e-6)));
    sweeps_free(&sweeps);
}

/* Both boxes slide at 7 m/s. Without a normal impulse that is no error. With one of 1 N s, friction of 0.2 N s may brake
   each contact of 1 kg by 0.2 m/s, and more does not. */
static void slip_counts_as_far_as_friction_can_brake_it(void **state) {
    (void)state;
    Boxes boxes;
    make_boxes(&boxes, 0, 0);
    assert_with_friction(&boxes.problem, 0);
    for (int k = 0; k < 2; k++) boxes.contacts[k].warm_normal = 1;
    boxes.bodies[1].velocity.y = -1;
    assert_with_friction(&boxes.problem, sqrt(2 * 0.2 * 0.2 / 4));
    for (int k = 0; k < 2; k++) boxes.contacts[k].warm_tangent = -0.2f;
    boxes.bodies[1].angular_velocity = 3 * 2 * 0.5f * 0.2f; /* what they take away */
    assert_with_friction(&boxes.problem, 0);
    boxes.contacts[2].mass_normal = NAN;
    boxes.contacts[2].bias = NAN;
    Sweeps sweeps = {0};
    assert_true(sweeps_begin(&sweeps, sweeps_best_kernel(), &boxes.problem, true, 1));
    assert_true(residual_of_visits_reaches(&sweeps, 4, 1e6f));
    sweeps_free(&sweeps);
}

/* Before any impulse, in any direction. */
static void the_motion_is_that_of_the_bodies(void **state) {
    (void)state;
    Boxes boxes;
    make_boxes(&boxes, -3, 5);
    for (int k = 0; k < 4; k++) {
        boxes.contacts[k].warm_normal = 2;
        boxes.contacts[k].bias = 9;
    }
    const float speed = sqrtf(7 * 7 + 5 * 5); /* of the box on the right */
    assert_true(residual_motion_reaches(&boxes.problem, 0.9999f * speed));
    assert_false(residual_motion_reaches(&boxes.problem, 1.0001f * speed));
    boxes.bodies[2].velocity.y = NAN;
    assert_true(residual_motion_reaches(&boxes.problem, 1e6f));
    boxes.problem.contact_count = 0;
    assert_false(residual_motion_reaches(&boxes.problem, 0.1f));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_residual_is_the_root_of_the_mean_square_over_contacts),
        cmocka_unit_test(what_parts_unpushed_is_no_miss),
        cmocka_unit_test(the_residual_is_that_after_the_warm_start),
        cmocka_unit_test(the_residual_is_measured_from_the_bias),
        cmocka_unit_test(spin_counts_at_the_arm),
        cmocka_unit_test(slip_counts_as_far_as_friction_can_brake_it),
        cmocka_unit_test(the_motion_is_that_of_the_bodies),
        cmocka_unit_test(random_problems_have_the_residual_of_the_definition),
        cmocka_unit_test(sweeps_reduce_the_residual),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
