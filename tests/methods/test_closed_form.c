/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The closed form against its own laws: what one answer of each contact makes of a contact, a box and a stack. */
#include "consistent.h"
#include "kernels.h"
#include "random_problem.h"

/* m/s^2 dt^2: what gravity makes of a body in one step, m. */
static const double fall = 10.0 / 60 / 60;

/* A body of 2 kg with this velocity touches a static one at its centre, and no force turns it. */
static ContactImpulse touch(const char *settings, Vec2 velocity, float friction, float bias, Vec2 *after) {
    const ProblemBody bodies[] = {{.inv_mass = 0}, {.inv_mass = 0.5f, .velocity = velocity}};
    const ContactPoint contact = {
        .a = 0, .b = 1, .normal = {0, 1}, .mass_normal = 2, .mass_tangent = 2, .friction = friction, .bias = bias};
    const ContactProblem problem = {2, 1, -1, world_dt, 0, bodies, &contact};
    BodyVelocity velocities[2];
    ContactImpulse impulse;
    ContactSolution solution = {velocities, &impulse, 0, {0}};
    solve_with(&solver_closed_form, settings, &problem, &solution);
    *after = velocities[1].linear;
    return impulse;
}

/* Exact: the contact ends with its target velocity. */
TEST(a_single_contact_without_friction_is_solved) {
    Vec2 after;
    const ContactImpulse impulse = touch("stiffness=0,damping=1", vec2(5, -3), 0, 0.25f, &after);
    assert_near(after.y, 0.25, 1e-6);
    assert_near(impulse.normal, 2 * 3.25, 1e-6);
    assert_true(after.x == 5 && impulse.tangent == 0);
}

TEST(settings_are_shares_of_it) {
    Vec2 after;
    touch("stiffness=0.25,damping=0.5", vec2(0, -3), 0, 0, &after);
    assert_near(after.y, -0.75, 1e-6);
    touch("stiffness=0,damping=0", vec2(0, -3), 0, 0, &after);
    assert_true(after.y == -3);
    touch("", vec2(0, -3), 0, 0, &after);
    assert_near(after.y, -3 * (1 - 0.325), 1e-6);
}

/* Facets have the velocities -3 + 0.5 and -3 - 0.5, and half of 2 kg / (1 + mu^2) each. */
TEST(friction_is_the_difference_of_two_facets) {
    Vec2 after;
    const double mass = 2 / 1.25 / 2;
    ContactImpulse impulse = touch("stiffness=0,damping=1", vec2(1, -3), 0.5f, 0, &after);
    assert_near(impulse.normal, mass * 2.5 + mass * 3.5, 1e-5);
    assert_near(impulse.tangent, 0.5 * (mass * 2.5 - mass * 3.5), 1e-5);
    /* One facet opens, so the impulse is on the edge of the cone; what slides is lifted. */
    impulse = touch("stiffness=0,damping=1", vec2(20, -3), 0.5f, 0, &after);
    assert_near(impulse.tangent, -0.5 * (double)impulse.normal, 1e-5);
    assert_near(impulse.normal, mass * 13, 1e-5);
    assert_true(after.y > 2);
}

/* Sum of half the masses of the four facets between a unit box of 1 kg and the ground, or another one, with friction
   0.2: along a facet of length 1.04 an impulse also turns boxes, with arms of 0.5 +- 0.1. */
static const double on_ground = 1 / (1.04 + 6 * 0.6 * 0.6) + 1 / (1.04 + 6 * 0.4 * 0.4),
                    on_box = 2 / (2 * 1.04 + 6 * (0.6 * 0.6 + 0.4 * 0.4));

static double depth_below(const World *world, int box) {
    const ContactProblem *problem = world_problem(world);
    for (int i = 0; i < problem->contact_count; i++)
        if (problem->contacts[i].b == box) return -(double)problem->contacts[i].separation;
    fail_msg("nothing below box %d", box);
    return 0;
}

static World *make_stack(const char *settings, int boxes) {
    World *world = make_world();
    add_ground(world, 0.2f);
    for (int i = 0; i < boxes; i++) add_box(world, 3, 0.2f, vec2(0, 0.5f + 0.999f * (float)i));
    OWN(ContactSolver) solver = make_solver(&solver_closed_form, settings);
    run(world, &solver, 1200);
    return world;
}

/* The box sinks until the spring carries it: S (k (depth - fall) - damping fall) = fall. */
TEST(a_box_at_rest_carries_its_weight) {
    OWN(World) *world = make_stack("stiffness=0.5,damping=0.075", 1);
    const ContactImpulse *impulses = world_solution(world)->impulses;
    assert_int_equal(world_problem(world)->contact_count, 2);
    assert_near(impulses[0].normal + impulses[1].normal, 3 * 10 * world_dt, 1e-4);
    assert_near(depth_below(world, 1), fall * (1 / on_ground - 0.575) / 0.5, 2e-5);
    assert_near(world_bodies(world)[1].velocity.y, 0, 1e-4);
}

/* Where it fails: the overlap grows with the load, and more between boxes than on the ground. */
TEST(a_stack_sinks_into_itself) {
    enum { BOXES = 3 };
    OWN(World) *world = make_stack("stiffness=0.5,damping=0", BOXES);
    assert_near(depth_below(world, 1), fall * (BOXES / on_ground - 0.5) / 0.5, 1e-4);
    for (int box = 2; box <= BOXES; box++)
        assert_near(depth_below(world, box), fall * (BOXES + 1 - box) / on_box / 0.5, 1e-4);
}

RUN_TESTS(NULL, NULL)
