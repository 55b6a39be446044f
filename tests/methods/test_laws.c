/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws in closed form that the engine must obey, and what is to do better. */
#include "worlds.h"

static const ContactSolverKind *judged; /* the solver whose laws are tested */

/* The settings of the judged solver: those given, which are numbers of sweeps, or a tight tolerance. */
static ContactSolver make_judged(const char *sweeps) {
    return make_solver(judged, judged == &solver_interior ? "near=1e-6"
                               : judged == &solver_admm   ? "near=1e-6,more=10000"
                                                          : sweeps);
}

/* Semi-implicit Euler: after k steps v = -g k dt and y = y0 - g dt^2 k (k + 1) / 2. */
TEST(a_free_box_falls_as_it_should) {
    OWN(World) *world = make_world();
    add_body(world,
             &(BodyDef){.size = {1, 1}, .mass = 3, .position = {2, 50}, .velocity = {1.5f, 0}, .angular_velocity = 2});
    OWN(ContactSolver) solver = make_judged("");
    const int k = 120;
    run(world, &solver, k);
    const Body *box = world_bodies(world);
    double dt = (double)world_dt;
    assert_near(box->velocity.y, -10 * k * dt, 1e-4f);
    assert_near(box->position.y, 50 - 10 * dt * dt * k * (k + 1) / 2, 1e-3f);
    assert_near(box->position.x, 2 + 1.5 * k * dt, 1e-4f);
    assert_near(box->angle, 2 * k * dt, 1e-4f);
}

/* Momentum and angular momentum about the origin of all bodies of a problem, before or after the solve. */
static void sum_momentum(const ContactProblem *problem, const BodyVelocity *after, double sum[3]) {
    sum[0] = sum[1] = sum[2] = 0;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        BodyVelocity v = after != NULL ? after[i] : (BodyVelocity){body->velocity, body->angular_velocity};
        if (body->inv_mass == 0) continue;
        double m = 1 / (double)body->inv_mass, x = (double)v.linear.x, y = (double)v.linear.y;
        sum[0] += m * x;
        sum[1] += m * y;
        sum[2] += m * ((double)body->position.x * y - (double)body->position.y * x) +
                  (double)v.angular / (double)body->inv_inertia;
    }
}

/* Two boxes crash in the air, off centre, turning, rubbing: what one loses the other gains. */
TEST(a_pair_impulse_keeps_momentum_and_angular_momentum) {
    OWN(World) *world = make_world();
    add_body(world, &(BodyDef){.size = {1, 2},
                               .mass = 3,
                               .friction = 0.6f,
                               .position = {0, 10},
                               .velocity = {4, 1},
                               .angular_velocity = 3});
    add_body(world, &(BodyDef){.size = {2, 1},
                               .mass = 0.5f,
                               .friction = 0.5f,
                               .position = {1.3f, 10.4f},
                               .angle = 0.3f,
                               .velocity = {-6, 0}});
    OWN(ContactSolver) solver = make_judged("");
    run(world, &solver, 1);
    const ContactProblem *problem = world_problem(world);
    const ContactSolution *solution = world_solution(world);
    assert_in_range(problem->contact_count, 1, 2);
    assert_true(solution->impulses[0].normal > 1);
    assert_true(fabsf(solution->impulses[0].tangent) > 0.1f);
    double before[3], after[3];
    sum_momentum(problem, NULL, before);
    sum_momentum(problem, solution->velocities, after);
    for (int i = 0; i < 3; i++) assert_near(before[i], after[i], 2e-4f);
}

/* A box of unit size on a slope of this angle under its own weight; friction of the pair is mu. How far it has
   slid after `steps`. */
static float slide(float angle, float mu, int steps) {
    OWN(World) *world = make_world();
    add_body(world, &(BodyDef){.size = {100, 2}, .fixed = true, .friction = mu, .angle = angle});
    Vec2 up = mat22_rotation(angle).column2;
    Vec2 start = vec2_scale(1.5f - 0.005f, up);
    add_body(world, &(BodyDef){.size = {1, 1}, .mass = 2, .friction = mu, .position = start, .angle = angle});
    OWN(ContactSolver) solver = make_judged("");
    run(world, &solver, steps);
    Vec2 moved = vec2_sub(world_bodies(world)[1].position, start);
    return sqrtf(vec2_dot(moved, moved));
}

/* It slides if and only if tan(angle) > mu, and then with a = g (sin - mu cos). */
TEST(a_box_slides_if_the_slope_is_steeper_than_the_friction_angle) {
    for (float mu = 0.2f; mu < 0.75f; mu += 0.25f) {
        float critical = atanf(mu);
        assert_true(slide(0.97f * critical, mu, 120) < 0.01f);
        float steep = 1.05f * critical, t = 120 * world_dt;
        float expected = 5 * (sinf(steep) - mu * cosf(steep)) * t * t;
        assert_near(slide(steep, mu, 120), expected, 0.03f * expected + 0.01f);
    }
}

/* In a resting stack the normal impulses under box i carry the weight of all above: m g dt (n - i). */
TEST(a_resting_stacks_impulses_carry_its_weight) {
    enum { BOXES = 5 };
    OWN(World) *world = make_world();
    add_ground(world, 0.2f);
    for (int i = 0; i < BOXES; i++) add_box(world, 2, 0.2f, vec2(0, 0.5f + (float)i));
    OWN(ContactSolver) solver = make_judged("k=30");
    run(world, &solver, 1200);
    const ContactProblem *problem = world_problem(world);
    assert_int_equal(problem->contact_count, 2 * BOXES);
    for (int i = 0; i < problem->contact_count; i += 2) {
        const ContactImpulse *impulses = &world_solution(world)->impulses[i];
        float weight = 2 * 10 * world_dt * (float)(BOXES - problem->contacts[i].a);
        assert_near(impulses[0].normal + impulses[1].normal, weight, 1e-3f * weight);
    }
}

/* Without restitution a box that lands stays down: normal impulse = m (v + g dt), so the momentum is gone. */
TEST(a_landing_box_stops) {
    OWN(World) *world = make_world();
    add_ground(world, 0.2f);
    add_body(world,
             &(BodyDef){.size = {1, 1}, .mass = 4, .friction = 0.2f, .position = {0, 0.495f}, .velocity = {0, -3}});
    OWN(ContactSolver) solver = make_judged("");
    run(world, &solver, 1);
    const ContactImpulse *impulses = world_solution(world)->impulses;
    assert_near(impulses[0].normal + impulses[1].normal, 4 * (3 + 10 * world_dt), 1e-4f);
    assert_near(world_bodies(world)[1].velocity.y, 0, 1e-5f);
}

/* Friction is an impulse of at most mu times the normal one: a fast box keeps sliding with v - mu (v_n + g dt). */
TEST(friction_stays_in_its_cone) {
    OWN(World) *world = make_sliding_box();
    OWN(ContactSolver) solver = make_judged("k=200");
    run(world, &solver, 1);
    assert_near(world_bodies(world)[1].velocity.x, 9 - 0.5f * 10 * world_dt, 1e-4f);
    const ContactProblem *problem = world_problem(world);
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactImpulse *impulse = &world_solution(world)->impulses[i];
        assert_true(fabsf(impulse->tangent) <= problem->contacts[i].friction * impulse->normal + 1e-7f);
    }
}

/* Each contact clamped by itself converges to less than the accumulated form; both must keep a box up. */
TEST(the_form_without_accumulation_keeps_a_box_up) {
    OWN(World) *world = make_world();
    add_ground(world, 0.2f);
    add_box(world, 1, 0.2f, vec2(0, 0.5f));
    OWN(ContactSolver) engine = make_engine("accumulate=off");
    run(world, &engine, 300);
    assert_near(world_bodies(world)[1].position.y, 0.5f, 0.02f);
    const ContactImpulse *impulses = world_solution(world)->impulses;
    assert_near(impulses[0].normal + impulses[1].normal, 10 * world_dt, 1e-3f);
}

int main(void) {
    static const ContactSolverKind *const kinds[] = {&solver_engine, &solver_interior, &solver_admm};
    int failed = 0;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        judged = kinds[i];
        failed += _cmocka_run_group_tests(judged->description.name, tests_of_file, test_count, NULL, NULL);
    }
    return failed;
}
