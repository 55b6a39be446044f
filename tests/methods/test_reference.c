/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference, held to closed forms. */
#include "reference_worlds.h"

static const double g = 10;

/* Under box i of n lie the weights of all above: m g dt (n - i). All are at rest, and stay there. */
TEST(a_stack_on_ground_carries_its_weight) {
    enum { BOXES = 10 };
    OWN(World) *world = make_world();
    add_ground(world, 0.2f);
    for (int i = 0; i < BOXES; i++) add_box(world, 2, 0.2f, vec2(0, 0.5f + (float)i));
    OWN(Reference) reference = {0};
    const ContactProblem *problem = solve_next(world, &reference);
    assert_int_equal(problem->contact_count, 2 * BOXES);
    for (int i = 0; i < BOXES; i++) {
        const ReferenceImpulse *impulses = &reference.impulses[2 * i];
        double weight = 2 * g * (double)world_dt * (BOXES - problem->contacts[2 * i].a);
        assert_near(impulses[0].normal + impulses[1].normal, weight, 1e-6 * weight);
        assert_near(reference.velocities[i + 1].y, 0, 1e-8);
        assert_near(reference.velocities[i + 1].spin, 0, 1e-8);
    }
}

/* A box of mass 2 on a slope, one step from rest: what its contacts push and drag together, and how fast it is down the
   slope. */
typedef struct OnSlope {
    double normal, tangent, speed;
} OnSlope;

static OnSlope put_on_slope(float angle, float mu) {
    OWN(World) *world = make_world();
    add_body(world, &(BodyDef){.size = {100, 2}, .fixed = true, .friction = mu, .angle = angle});
    Mat22 slope = mat22_rotation(angle);
    Vec2 start = vec2_scale(1.495f, slope.column2);
    add_body(world, &(BodyDef){.size = {1, 1}, .mass = 2, .friction = mu, .position = start, .angle = angle});
    OWN(Reference) reference = {0};
    const ContactProblem *problem = solve_next(world, &reference);
    assert_int_equal(problem->contact_count, 2);
    OnSlope found = {reference.impulses[0].normal + reference.impulses[1].normal,
                     reference.impulses[0].tangent + reference.impulses[1].tangent,
                     -reference.velocities[1].x * (double)slope.column1.x -
                         reference.velocities[1].y * (double)slope.column1.y};
    return found;
}

/* It sticks if and only if tan(angle) <= mu: friction is then m g dt sin(angle); else mu m g dt cos(angle), and the box
   is off at g dt (sin - mu cos). */
TEST(a_box_on_a_slope_sticks_below_the_friction_angle) {
    for (float mu = 0.2f; mu < 0.75f; mu += 0.25f) {
        double dt = (double)world_dt;
        float gentle = 0.97f * atanf(mu), steep = 1.05f * atanf(mu);
        OnSlope sticks = put_on_slope(gentle, mu);
        assert_near(sticks.normal, 2 * g * dt * cos((double)gentle), 1e-6);
        assert_near(fabs(sticks.tangent), 2 * g * dt * sin((double)gentle), 1e-6);
        assert_near(sticks.speed, 0, 1e-8);
        OnSlope slides = put_on_slope(steep, mu);
        assert_near(slides.normal, 2 * g * dt * cos((double)steep), 1e-6);
        assert_near(fabs(slides.tangent), (double)mu * slides.normal, 1e-6);
        assert_near(slides.speed, g * dt * (sin((double)steep) - (double)mu * cos((double)steep)), 1e-6);
    }
}

/* 1000 kg on 1 kg on the ground: what slows the sweeps (10 of them leave half the weight) does not matter here. */
TEST(a_light_box_carries_a_heavy_one) {
    OWN(World) *world = make_heavy_on_light(1000, 0.5f, 1.5f);
    OWN(Reference) reference = {0};
    solve_next(world, &reference);
    double dt = (double)world_dt;
    assert_near(reference.impulses[2].normal + reference.impulses[3].normal, 1000 * g * dt, 1e-3);
    assert_near(reference.impulses[0].normal + reference.impulses[1].normal, 1001 * g * dt, 1e-3);
    assert_near(reference.velocities[1].y, 0, 1e-7);
    assert_near(reference.velocities[2].y, 0, 1e-7);
}

/* Static ground that moves at 0.1 m/s takes a box along: its friction could give it mu g dt = 0.17 m/s in the step. */
TEST(ground_that_moves_takes_a_box_along) {
    OWN(World) *world = make_world();
    add_body(world,
             &(BodyDef){.size = {100, 20}, .fixed = true, .friction = 1, .position = {0, -10}, .velocity = {0.1f, 0}});
    add_box(world, 3, 1, vec2(0, 0.5f));
    OWN(Reference) reference = {0};
    solve_next(world, &reference);
    assert_near(reference.velocities[0].x, 0.1f, 0);
    assert_near(reference.velocities[1].x, 0.1, 1e-7);
    assert_near(reference.velocities[1].y, 0, 1e-7);
    assert_near(fabs(reference.impulses[0].tangent + reference.impulses[1].tangent), 3 * 0.1, 1e-6);
}

/* A plate that lies on more boxes than a sweep has rounds: together they carry it, and the ground them. */
TEST(a_plate_lies_on_very_many_boxes) {
    enum { BOXES = 70 };
    OWN(World) *world = make_world();
    add_ground(world, 0.2f);
    for (int i = 0; i < BOXES; i++)
        add_body(world,
                 &(BodyDef){.size = {0.5f, 1}, .mass = 1, .friction = 0.2f, .position = {0.6f * (float)i, 0.5f}});
    add_body(world, &(BodyDef){.size = {60, 1}, .mass = 500, .friction = 0.2f, .position = {0.3f * (BOXES - 1), 1.5f}});
    OWN(Reference) reference = {0};
    run_engine(world, "k=1", 1);
    const ContactProblem *problem = world_problem(world);
    assert_int_equal(problem->contact_count, 4 * BOXES);
    assert_ok(reference_solve(&reference, problem, NULL, &error), error);
    double on_ground = 0, on_boxes = 0, dt = (double)world_dt;
    for (int i = 0; i < problem->contact_count; i++)
        *(problem->contacts[i].a == 0 ? &on_ground : &on_boxes) += reference.impulses[i].normal;
    assert_near(on_boxes, 500 * g * dt, 0.01);
    assert_near(on_ground, (500 + BOXES) * g * dt, 0.01);
}

/* Four boxes that touch without overlap; the top one, 20 kg, comes down at 5 m/s. */
static World *make_shifted_tower(void) {
    Error error = {0};
    World *world = world_create(&(WorldDef){.gravity = {0, -10}, .warm_starting = true}, &error);
    assert_ok(world != NULL, error);
    add_ground(world, 0.2f);
    const Vec2 places[] = {{0, 0.5f}, {0.1f, 1.5f}, {-0.1f, 2.5f}, {0.3f, 3.55f}};
    for (int i = 0; i < 4; i++)
        add_body(world, &(BodyDef){.size = {1, 1},
                                   .mass = i == 3 ? 20 : 2,
                                   .friction = 0.2f,
                                   .position = places[i],
                                   .velocity = {0, i == 3 ? -5.0f : 0.0f}});
    return world;
}

/* The fastest spin of the reference, which must be that of many sweeps with conjugate gradients. */
static double fastest_spin(Reference *reference, const ContactProblem *problem) {
    Error error = {0};
    BodyVelocity velocities[8];
    ContactImpulse impulses[16];
    ContactSolution found = {velocities, impulses, 0, {0}};
    assert_ok(reference_solve(reference, problem, NULL, &error), error);
    assert_true(reference->residual <= tight);
    solve_with(&solver_nncg, "k=3000", problem, &found);
    double fastest = 0;
    for (int i = 0; i < problem->body_count; i++) {
        assert_velocity(velocities[i], reference->velocities[i].x, reference->velocities[i].y,
                        reference->velocities[i].spin, 1e-4);
        fastest = fmax(fastest, fabs(reference->velocities[i].spin));
    }
    return fastest;
}

/* Boxes that just touch part by a rounding error now and then, and lose contacts. The next step is then another
   problem: with all contacts the tower stands; without one of the lowest box and one between the second and the third,
   a box turns at more than 4 rad/s. */
TEST(contacts_lost_by_rounding_change_the_solution) {
    OWN(World) *world = make_shifted_tower();
    OWN(Reference) reference = {0};
    ContactSolver converged = make_solver(&solver_reference, "");
    run(world, &converged, 1);
    free_solver(&converged);
    const ContactProblem *all = solve_next(world, &reference);
    assert_int_equal(all->contact_count, 8);
    assert_near(fastest_spin(&reference, all), 0, 1e-8);
    double fastest = 0;
    for (int choice = 0; choice < 4; choice++) {
        ContactPoint contacts[8];
        int count = 0;
        for (int i = 0; i < 8; i++)
            if (i != choice % 2 && i != 4 + choice / 2) contacts[count++] = all->contacts[i];
        ContactProblem fewer = *all;
        fewer.contacts = contacts;
        fewer.contact_count = count;
        fastest = fmax(fastest, fastest_spin(&reference, &fewer));
    }
    assert_true(fastest > 4);
}

TEST(nothing_that_touches_is_solved_at_once) {
    OWN(World) *world = make_world();
    add_body(world, &(BodyDef){.size = {1, 1}, .mass = 2, .position = {0, 9}, .velocity = {3, 0}});
    OWN(Reference) reference = {0};
    solve_next(world, &reference);
    assert_true(reference.residual == 0);
    assert_near(reference.velocities[0].x, 3, 0);
    assert_near(reference.velocities[0].y, -g * (double)world_dt, 1e-7);
}

RUN_TESTS(NULL, NULL)

/* The floor of the world's next step. */
static double floor_of(World *world) {
    Error error = {0};
    double floor;
    OWN(Reference) answer = {0}, other = {0};
    const ContactProblem *problem = solve_next(world, &answer);
    assert_ok(reference_floor(&other, problem, &answer, 8, &floor, &error), error);
    return floor;
}

/* Its two contacts share friction as they like, but it rests. */
TEST(a_box_on_ground_has_no_floor) {
    OWN(World) *world = make_world();
    add_ground(world, 0.6f);
    add_box(world, 2, 0.6f, vec2(0, 0.5f));
    assert_near(floor_of(world), 0, 1e-9);
}

/* Nothing says how hard two walls press on a box that fits between them. With friction it hangs, or falls freely by
   g dt, or anything between. */
static double floor_between_walls(float friction) {
    OWN(World) *world = make_world();
    for (int side = -1; side <= 1; side += 2)
        add_body(
            world,
            &(BodyDef){.size = {1, 10}, .fixed = true, .friction = friction, .position = {0.999f * (float)side, 0}});
    add_box(world, 2, friction, vec2(0, 0));
    return floor_of(world);
}

TEST(a_box_between_walls_hangs_or_falls) {
    const double fall = g * (double)world_dt;
    assert_near(floor_between_walls(0), 0, 1e-9);
    const double floor = floor_between_walls(0.8f);
    assert_true(floor > fall / 4 && floor < fall * (1 + 1e-6));
}

/* The corner r = (1/2, -1/2) of a box of 1 kg and 1 m leaves ground of friction 3 at 1 m/s and slides at 4 m/s. Normal
   and tangent velocity change by 5/2 p + 3/2 q and 3/2 p + 5/2 q (Painleve). So it is right to leave, p = 0; to slide
   on at 1 m/s, p = 1/2 and q = -3/2; and to stick, p = 7/8 and q = -17/8. */
TEST(a_corner_leaves_or_slides_or_sticks) {
    const ProblemBody bodies[] = {{.inv_mass = 0}, {.velocity = {4, 1}, .inv_mass = 1, .inv_inertia = 6}};
    const ContactPoint contact = {.a = 0,
                                  .b = 1,
                                  .normal = {0, 1},
                                  .arm_b = {0.5f, -0.5f},
                                  .mass_normal = 0.4f,
                                  .mass_tangent = 0.4f,
                                  .friction = 3};
    const ContactProblem problem = {
        .body_count = 2, .contact_count = 1, .bomb = -1, .dt = world_dt, .bodies = bodies, .contacts = &contact};
    OWN(Reference) answer = {0}, other = {0};
    double floor;
    assert_ok(reference_solve(&answer, &problem, NULL, &error), error);
    assert_true(reference_converged(&answer));
    assert_near(answer.velocities[1].y, 1, 1e-9); /* it leaves; so it slides from its free velocity by (3/2, 1/2, 3), */
    assert_ok(reference_floor(&other, &problem, &answer, 16, &floor, &error), error);
    assert_near(floor, sqrt(17 * 17 + 7 * 7 + 30 * 30 / 6.0) / 8, 1e-9); /* and sticks by (17/8, 7/8, 15/4) */
    const ContactImpulse slides = {0.5f, -1.5f};
    floor = 0;
    assert_ok(reference_raise_floor(&other, &problem, &answer, &slides, &floor, &error), error);
    assert_near(floor, sqrt(1.5 * 1.5 + 0.5 * 0.5 + 3 * 3 / 6.0), 1e-9);
}
