/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The laws of contact, on a contact whose numbers are known without computing, and on solutions of solvers. */
#include "kernels.h"
#include "random_problem.h"
#include "worlds.h"

#include "methods/criteria.h"
#include "methods/reference.h"

/* A ball of 2 kg above fixed ground, friction 0.5, that came with 3 m/s downwards and 4 m/s along the tangent. Half a
   tenth of a second deep, so that lengths have round numbers. */
typedef struct Ball {
    ProblemBody bodies[2];
    ContactPoint contact;
    BodyVelocity velocities[2];
    ContactImpulse impulse;
    ContactProblem problem;
    ContactSolution solution;
} Ball;

/* With these impulses, and the velocities that they make. */
static ContactCriteria criteria_of(Ball *ball, float normal, float tangent, bool push_out) {
    ball->bodies[0] = (ProblemBody){.size = {9, 9}};
    ball->bodies[1] = (ProblemBody){.inv_mass = 0.5f, .inv_inertia = 1, .velocity = {4, -3}};
    ball->contact.a = 0;
    ball->contact.b = 1;
    ball->contact.normal = vec2(0, 1);
    ball->contact.friction = 0.5f;
    ball->impulse = (ContactImpulse){normal, tangent};
    ball->velocities[1] = (BodyVelocity){vec2(4 + tangent / 2, -3 + normal / 2), 0};
    ball->problem = (ContactProblem){.body_count = 2,
                                     .contact_count = 1,
                                     .bomb = -1,
                                     .dt = 0.25f,
                                     .bodies = ball->bodies,
                                     .contacts = &ball->contact};
    ball->solution = (ContactSolution){.velocities = ball->velocities, .impulses = &ball->impulse};
    return contact_criteria(&ball->problem, &ball->solution, push_out);
}

/* 6 N s stop it, and friction takes 3 N s of the 8 that slide. */
TEST(a_solution_breaks_no_law) {
    Ball ball = {0};
    const ContactCriteria found = criteria_of(&ball, 6, -3, true);
    assert_true(found.signorini == 0 && found.cone == 0 && found.dissipation == 0 && found.penetration == 0);
    assert_near(found.energy, 2 / 2. * (2.5 * 2.5 - 25), 1e-12);
}

TEST(signorini_is_the_work_of_the_gap) {
    Ball ball = {0};
    assert_near(criteria_of(&ball, 8, -4, true).signorini, 8 * 1, 1e-12); /* it jumps off with 1 m/s */
    assert_near(criteria_of(&ball, 2, -1, true).signorini, 2 * 2, 1e-12); /* 2 m/s inwards are left */
    ball.contact.bias = 1;
    assert_true(criteria_of(&ball, 8, -4, true).signorini == 0);
    assert_near(criteria_of(&ball, 8, -4, false).signorini, 8, 1e-12); /* to part is not its aim */
    ball.contact.bias = -1;                                            /* a gap may close, for all */
    assert_true(criteria_of(&ball, 4, -2, false).signorini == 0);
}

/* Beside it by the angle of the cone; behind its tip; straight behind it. */
TEST(the_cone_is_as_far_as_its_nearest_point) {
    Ball ball = {0};
    assert_near(criteria_of(&ball, 2, -3, true).cone, (3 - 1) / sqrt(1.25), 1e-12);
    assert_near(criteria_of(&ball, 0, 1, true).cone, 1 / sqrt(1.25), 1e-12);
    assert_near(criteria_of(&ball, -4, 3, true).cone, 5, 1e-12);
    assert_near(criteria_of(&ball, -2, 0, true).cone, 2, 1e-12);
    assert_true(criteria_of(&ball, 2, 1, true).cone == 0);
}

/* It slides with 3 m/s where friction pulls by 2 of 3 N s; what pushes along gives energy. */
TEST(friction_takes_all_that_it_can) {
    Ball ball = {0};
    assert_near(criteria_of(&ball, 6, -2, true).dissipation, (3 - 2) * 3, 1e-12);
    assert_near(criteria_of(&ball, 6, 2, true).dissipation, (3 + 2) * 5, 1e-12);
    /* Sticking may need any impulse inside the cone: 8 N s of friction 2 stop all sliding. */
    criteria_of(&ball, 16, -8, true);
    assert_true(contact_criteria(&ball.problem, &ball.solution, true).dissipation == 0);
}

/* dt is a quarter of a second. */
TEST(penetration_is_where_the_step_leads) {
    Ball ball = {.contact = {.separation = -0.5f}};
    assert_near(criteria_of(&ball, 6, -3, true).penetration, 0.5, 1e-12);
    assert_near(criteria_of(&ball, 2, -1, true).penetration, 0.5 + 2 * 0.25, 1e-12);
    assert_near(criteria_of(&ball, 7, -3, true).penetration, 0.5 - 0.5 * 0.25, 1e-12);
    assert_true(criteria_of(&ball, 60, -3, true).penetration == 0);
}

TEST(without_impulses_only_motion_is_judged) {
    Ball ball = {0};
    criteria_of(&ball, 6, -3, true);
    ball.impulse = (ContactImpulse){0};
    const ContactCriteria found = contact_criteria(&ball.problem, &ball.solution, true);
    assert_true(isnan(found.signorini) && isnan(found.cone) && isnan(found.dissipation) && found.energy < -1);
    const ContactCriteria still = criteria_of(&ball, 0, 0, true); /* it passes through */
    assert_true(isnan(still.signorini) && still.energy == 0 && still.penetration > 0.7);
    ball.problem.contact_count = 0; /* no law to break */
    assert_true(contact_criteria(&ball.problem, &ball.solution, true).signorini == 0);
}

TEST(what_is_no_number_is_infinite) {
    Ball ball = {0};
    const ContactCriteria found = criteria_of(&ball, NAN, 0, true), far = criteria_of(&ball, 0, INFINITY, true);
    assert_true(isinf(found.signorini) && isinf(found.cone) && isinf(found.dissipation) && isinf(found.penetration));
    assert_true(isinf(found.energy) && isinf(far.energy));
}

/* Two boxes that touch at arms: what spin adds to the velocity of the contact, on both sides. */
TEST(spin_counts_at_the_arms) {
    const ProblemBody bodies[2] = {{.inv_mass = 1, .inv_inertia = 6}, {.inv_mass = 1, .inv_inertia = 6}};
    const ContactPoint contact = {.a = 0, .b = 1, .normal = {1, 0}, .arm_a = {1, 2}, .arm_b = {-3, 4}, .friction = 1};
    const BodyVelocity velocities[2] = {{{0, 0}, 5}, {{0, 0}, 7}};
    ContactImpulse impulse = {1, 0};
    const ContactProblem problem = {
        .body_count = 2, .contact_count = 1, .dt = 1, .bodies = bodies, .contacts = &contact};
    const ContactSolution solution = {.velocities = (BodyVelocity *)velocities, .impulses = &impulse};
    /* b moves by 7 x (-3, 4) = (-28, -21), a by 5 x (1, 2) = (-10, 5): apart by -18 along x, -26 along y. */
    const ContactCriteria found = contact_criteria(&problem, &solution, true);
    assert_near(found.signorini, 18, 1e-12);
    assert_near(found.dissipation, 26, 1e-12);
    assert_near(found.penetration, 18, 1e-12);
    assert_near(found.energy, (25 + 49) / 12., 1e-6);
}

/* Solvers: the converged solution breaks no law beyond the rounding of its impulses; one sweep breaks those of
   contact. */
TEST(the_reference_keeps_all_laws) {
    static RandomProblem random;
    const ContactSolver one = make_engine("k=1,warm=off");
    uint32_t seed = 3;
    int worse = 0;
    for (int run = 0; run < 20; run++) {
        make_random(&random, &seed, 10, 0.3f, 1);
        OWN(Reference) reference = {0};
        Error failure = {0};
        OWN(ContactSolution) solution = make_solution(&random.problem);
        assert_ok(reference_solve(&reference, &random.problem, NULL, &failure), failure);
        if (reference.residual <= REFERENCE_TOLERANCE) {
            reference_round(&reference, &random.problem, &solution);
            const ContactCriteria found = contact_criteria(&random.problem, &solution, true);
            assert_true(found.signorini < 1e-3 && found.cone < 1e-3 && found.dissipation < 1e-3);
            assert_ok(one.kind->solve(one.state, &random.problem, &solution, &failure), failure);
            const ContactCriteria swept = contact_criteria(&random.problem, &solution, true);
            worse += swept.signorini > 10 * found.signorini && swept.dissipation > 10 * found.dissipation;
        }
    }
    assert_true(worse > 10);
    one.kind->destroy(one.state);
}

RUN_TESTS(NULL, NULL)
