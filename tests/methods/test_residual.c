/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The residual of problems whose velocities are known without computing. */
#include "residuals.h"
#include "kernels.h"
#include "random_problem.h"

#include "methods/residual.h"

/* Two boxes side by side on the ground, two contacts each: the velocities of the boxes are those that the contacts
   have, but for their sign. */
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
                                      .bomb = -1,
                                      .dt = world_dt,
                                      .bodies = boxes->bodies,
                                      .contacts = boxes->contacts};
}

/* Reached from below and missed from above, by every kernel, with a rounding between. */
static void assert_residual(const ContactProblem *problem, double residual) {
    for (SweepKernel kernel = 0; kernel < SWEEP_KERNELS; kernel++) {
        if (!sweeps_can(kernel)) continue;
        OWN(Sweeps) sweeps = {0};
        assert_true(sweeps_begin(&sweeps, kernel, problem, true));
        if (residual > 0) assert_true(residual_reaches(&sweeps, problem->contact_count, (float)(0.9999 * residual)));
        assert_false(residual_reaches(&sweeps, problem->contact_count, (float)(1.0001 * residual + 1e-5)));
    }
    OWN(ContactSolution) warm = make_solution(problem);
    sequential_impulses_begin(problem, &engine_options, &warm);
    if (residual > 0) assert_true(residual_reaches_scalar(problem, &warm, (float)(0.9999 * residual)));
    assert_false(residual_reaches_scalar(problem, &warm, (float)(1.0001 * residual + 1e-5)));
}

TEST(the_residual_is_the_root_of_the_mean_square_over_contacts) {
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

TEST(what_parts_unpushed_is_no_miss) {
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
TEST(the_residual_is_that_after_the_warm_start) {
    Boxes boxes;
    make_boxes(&boxes, -3, 0);
    for (int k = 0; k < 2; k++) boxes.contacts[k].warm_normal = 3;
    assert_residual(&boxes.problem, 0);
    for (int k = 0; k < 2; k++) boxes.contacts[k].warm_normal = 2;
    assert_residual(&boxes.problem, 1 / sqrt(2));
}

TEST(the_residual_is_measured_from_the_bias) {
    Boxes boxes;
    make_boxes(&boxes, -3, 0);
    for (int k = 0; k < 4; k++) boxes.contacts[k].bias = 0.5f;
    assert_residual(&boxes.problem, sqrt((3.5 * 3.5 + 0.5 * 0.5) / 2));
}

TEST(spin_counts_at_the_arm) {
    Boxes boxes;
    make_boxes(&boxes, 0, 0);
    /* One corner goes down with half the spin, the other up. */
    boxes.bodies[2].angular_velocity = 8;
    assert_residual(&boxes.problem, sqrt(4 * 4 / 4.0));
}

TEST(random_problems_have_the_residual_of_the_definition) {
    static RandomProblem random;
    uint32_t seed = 6;
    for (int run = 0; run < 50; run++) {
        make_random(&random, &seed, 2 + run, 0.3f, 1);
        assert_residual(&random.problem, residual_of(&random.problem));
    }
}

static double sum_of_visits(const Sweeps *sweeps) {
    double sum = 0;
    for (int i = 0; i < sweeps->pair_count; i++) sum += (double)residual_of_pair(sweeps, i);
    return sum;
}

/* The root mean square of what visits would change. */
static void assert_with_friction(const ContactProblem *problem, double residual) {
    OWN(Sweeps) sweeps = {0};
    assert_true(sweeps_begin(&sweeps, sweeps_best_kernel(), problem, true));
    const double squared = sum_of_visits(&sweeps), wanted = residual * residual * problem->contact_count;
    if (!(fabs(squared - wanted) <= 2e-4 * wanted + 1e-12)) fail_msg("%g, not %g (m/s)^2", squared, wanted);
}

/* Both boxes slide at 7 m/s. Without a normal impulse that is no error. With one of 1 N s, friction of 0.2 N s may
   brake each contact of 1 kg by 0.2 m/s, and more does not. */
TEST(slip_counts_as_far_as_friction_can_brake_it) {
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
    OWN(Sweeps) sweeps = {0};
    assert_true(sweeps_begin(&sweeps, sweeps_best_kernel(), &boxes.problem, true));
    assert_true(isnan(sum_of_visits(&sweeps)));
}

/* Before any impulse, in any direction. */
TEST(the_motion_is_that_of_the_bodies) {
    Boxes boxes;
    make_boxes(&boxes, -3, 5);
    for (int k = 0; k < 4; k++) {
        boxes.contacts[k].warm_normal = 2;
        boxes.contacts[k].bias = 9;
    }
    for (int k = 0; k < 4; k++)
        assert_near(residual_of_motion(&boxes.problem, k), k < 2 ? 7 * 7 + 3 * 3 : 7 * 7 + 5 * 5, 1e-5);
    boxes.bodies[2].velocity.y = NAN;
    assert_true(isnan(residual_of_motion(&boxes.problem, 3)));
}

RUN_TESTS(NULL, NULL)
