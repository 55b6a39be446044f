/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reference, against closed forms, against very many plain sweeps, and against itself. */
#include "worlds.h"

#include "solvers/reference.h"
#include "solvers/sequential_impulses.h"

#include <math.h>

static const double g = 10, tight = 1e-9;
enum { MANY = 200000, VISITS = 20 * REFERENCE_MAX_VISITS };

/* Solves the contact problem that the world's next step meets. The engine makes the step. */
static const ContactProblem *solve_next(World *world, Reference *reference) {
    ContactSolver engine = make_engine("k=1");
    run(world, &engine, 1);
    free_solver(&engine);
    Error error = {0};
    assert_ok(reference_solve(reference, world_problem(world), tight, VISITS, NULL, &error), error);
    if (!(reference->residual <= tight))
        fail_msg("residual %g after %d sweeps", reference->residual, reference->sweeps);
    return world_problem(world);
}

/* Under box i of n lie the weights of all above: m g dt (n - i). All are at rest, and stay there. */
static void a_stack_on_ground_carries_its_weight(void **state) {
    (void)state;
    enum { BOXES = 10 };
    World *world = make_world();
    add_ground(world, 0.2f);
    for (int i = 0; i < BOXES; i++)
        add_body(world, &(BodyDef){.size = {1, 1}, .mass = 2, .friction = 0.2f, .position = {0, 0.5f + (float)i}});
    Reference reference = {0};
    const ContactProblem *problem = solve_next(world, &reference);
    assert_int_equal(problem->contact_count, 2 * BOXES);
    for (int i = 0; i < BOXES; i++) {
        const ReferenceImpulse *impulses = &reference.impulses[2 * i];
        double weight = 2 * g * (double)world_dt * (BOXES - problem->contacts[2 * i].a);
        assert_near(impulses[0].normal + impulses[1].normal, weight, 1e-6 * weight);
        assert_near(reference.velocities[i + 1].y, 0, 1e-8);
        assert_near(reference.velocities[i + 1].spin, 0, 1e-8);
    }
    reference_free(&reference);
    world_destroy(world);
}

/* A box of mass 2 on a slope, one step from rest: what its contacts push and drag together, and how fast it is down the
   slope. */
typedef struct OnSlope {
    double normal, tangent, speed;
} OnSlope;

static OnSlope put_on_slope(float angle, float mu) {
    World *world = make_world();
    add_body(world, &(BodyDef){.size = {100, 2}, .fixed = true, .friction = mu, .angle = angle});
    Mat22 slope = mat22_rotation(angle);
    Vec2 start = vec2_scale(1.495f, slope.column2);
    add_body(world, &(BodyDef){.size = {1, 1}, .mass = 2, .friction = mu, .position = start, .angle = angle});
    Reference reference = {0};
    const ContactProblem *problem = solve_next(world, &reference);
    assert_int_equal(problem->contact_count, 2);
    OnSlope found = {reference.impulses[0].normal + reference.impulses[1].normal,
                     reference.impulses[0].tangent + reference.impulses[1].tangent,
                     -reference.velocities[1].x * (double)slope.column1.x -
                         reference.velocities[1].y * (double)slope.column1.y};
    reference_free(&reference);
    world_destroy(world);
    return found;
}

/* It sticks if and only if tan(angle) <= mu: friction is then m g dt sin(angle); else mu m g dt cos(angle), and the box
   is off at g dt (sin - mu cos). */
static void a_box_on_a_slope_sticks_below_the_friction_angle(void **state) {
    (void)state;
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

/* Two boxes meet head on in the air: they go on as one, with the mean of their momenta, and keep falling. */
static void boxes_that_crash_go_on_together(void **state) {
    (void)state;
    World *world = make_world();
    add_body(world, &(BodyDef){.size = {1, 1}, .mass = 3, .position = {0, 10}, .velocity = {4, 0}});
    add_body(world, &(BodyDef){.size = {1, 1}, .mass = 1, .position = {0.995f, 10}, .velocity = {-2, 0}});
    Reference reference = {0};
    solve_next(world, &reference);
    for (int i = 0; i < 2; i++) {
        assert_near(reference.velocities[i].x, (3 * 4 - 1 * 2) / 4.0, 1e-6);
        assert_near(reference.velocities[i].y, -g * (double)world_dt, 1e-6);
        assert_near(reference.velocities[i].spin, 0, 1e-6);
    }
    assert_near(reference.impulses[0].normal + reference.impulses[1].normal, 3 * (4 - 2.5), 1e-6);
    reference_free(&reference);
    world_destroy(world);
}

/* 1000 kg on 1 kg on the ground: what slows the sweeps (10 of them leave half the weight) does not matter here. */
static void a_light_box_carries_a_heavy_one(void **state) {
    (void)state;
    World *world = make_world();
    add_ground(world, 0.2f);
    add_body(world, &(BodyDef){.size = {1, 1}, .mass = 1, .friction = 0.2f, .position = {0, 0.5f}});
    add_body(world, &(BodyDef){.size = {1, 1}, .mass = 1000, .friction = 0.2f, .position = {0, 1.5f}});
    Reference reference = {0};
    solve_next(world, &reference);
    double dt = (double)world_dt;
    assert_near(reference.impulses[2].normal + reference.impulses[3].normal, 1000 * g * dt, 1e-3);
    assert_near(reference.impulses[0].normal + reference.impulses[1].normal, 1001 * g * dt, 1e-3);
    assert_near(reference.velocities[1].y, 0, 1e-7);
    assert_near(reference.velocities[2].y, 0, 1e-7);
    reference_free(&reference);
    world_destroy(world);
}

/* A leaning heap: five boxes hit by a heavy one from the side, as they stand after that many steps. */
static World *make_heap(int steps) {
    World *world = make_world();
    add_ground(world, 0.4f);
    for (int i = 0; i < 5; i++)
        add_body(world, &(BodyDef){.size = {1, 1},
                                   .mass = 1,
                                   .friction = 0.4f,
                                   .position = {0.04f * (float)(i * i), 0.495f + 0.99f * (float)i}});
    add_body(world, &(BodyDef){.size = {1, 1},
                               .mass = 20,
                               .friction = 0.4f,
                               .position = {-1.15f, 1.6f},
                               .velocity = {4, -1},
                               .angular_velocity = 1});
    ContactSolver engine = make_engine("");
    run(world, &engine, steps);
    free_solver(&engine);
    return world;
}

/* Plain sweeps in double, written down apart from the reference. */
typedef struct Plain {
    ReferenceVelocity velocities[8];
    ReferenceImpulse impulses[64];
} Plain;

/* Velocity of b's point as seen from a's, along x, y. */
static double slip(const Plain *plain, const ContactPoint *contact, double x, double y) {
    const ReferenceVelocity *a = &plain->velocities[contact->a], *b = &plain->velocities[contact->b];
    double along_x = b->x - b->spin * (double)contact->arm_b.y - a->x + a->spin * (double)contact->arm_a.y;
    double along_y = b->y + b->spin * (double)contact->arm_b.x - a->y - a->spin * (double)contact->arm_a.x;
    return along_x * x + along_y * y;
}

static void push(Plain *plain, const ProblemBody *bodies, int body, Vec2 arm, double x, double y) {
    ReferenceVelocity *velocity = &plain->velocities[body];
    velocity->x += (double)bodies[body].inv_mass * x;
    velocity->y += (double)bodies[body].inv_mass * y;
    velocity->spin += (double)bodies[body].inv_inertia * ((double)arm.x * y - (double)arm.y * x);
}

static void push_both(Plain *plain, const ContactProblem *problem, const ContactPoint *contact, double x, double y) {
    push(plain, problem->bodies, contact->a, contact->arm_a, -x, -y);
    push(plain, problem->bodies, contact->b, contact->arm_b, x, y);
}

static void plain_begin(Plain *plain, const ContactProblem *problem) {
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        plain->velocities[i] =
            (ReferenceVelocity){(double)body->velocity.x, (double)body->velocity.y, (double)body->angular_velocity};
    }
    for (int i = 0; i < problem->contact_count; i++) plain->impulses[i] = (ReferenceImpulse){0, 0};
}

static void plain_sweep(Plain *plain, const ContactProblem *problem) {
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        ReferenceImpulse *impulse = &plain->impulses[i];
        double x = (double)contact->normal.x, y = (double)contact->normal.y, before = impulse->normal;
        impulse->normal =
            fmax(before + (double)contact->mass_normal * ((double)contact->bias - slip(plain, contact, x, y)), 0);
        push_both(plain, problem, contact, (impulse->normal - before) * x, (impulse->normal - before) * y);
        double limit = (double)contact->friction * impulse->normal;
        before = impulse->tangent;
        impulse->tangent =
            fmax(fmin(before - (double)contact->mass_tangent * slip(plain, contact, y, -x), limit), -limit);
        push_both(plain, problem, contact, (impulse->tangent - before) * y, (impulse->tangent - before) * -x);
    }
}

static void many_plain_sweeps_find_the_same(void **state) {
    (void)state;
    for (int steps = 2; steps < 26; steps += 4) {
        World *world = make_heap(steps);
        Reference reference = {0};
        const ContactProblem *problem = solve_next(world, &reference);
        assert_true(problem->contact_count >= 7);
        Plain plain;
        plain_begin(&plain, problem);
        for (int sweep = 0; sweep < MANY; sweep++) plain_sweep(&plain, problem);
        for (int i = 0; i < problem->body_count; i++) {
            assert_near(plain.velocities[i].x, reference.velocities[i].x, 1e-8);
            assert_near(plain.velocities[i].y, reference.velocities[i].y, 1e-8);
            assert_near(plain.velocities[i].spin, reference.velocities[i].spin, 1e-8);
        }
        reference_free(&reference);
        world_destroy(world);
    }
}

/* What every solver that converges does with the reference's impulses as its warm start: nothing but move the last
   bits of a float. */
static void assert_fixed_point(const ContactSolverKind *kind, const char *text, const ContactProblem *problem,
                               const Reference *reference) {
    Error error = {0};
    ContactSolver solver = make_solver(kind, text);
    BodyVelocity velocities[8];
    ContactImpulse impulses[64];
    ContactSolution solution = {velocities, impulses};
    assert_ok(kind->solve(solver.state, problem, &solution, &error), error);
    for (int i = 0; i < problem->body_count; i++) {
        assert_near(velocities[i].linear.x, reference->velocities[i].x, 2e-5);
        assert_near(velocities[i].linear.y, reference->velocities[i].y, 2e-5);
        assert_near(velocities[i].angular, reference->velocities[i].spin, 2e-5);
    }
    free_solver(&solver);
}

static void the_reference_is_a_fixed_point_of_every_convergent_solver(void **state) {
    (void)state;
    for (int steps = 2; steps < 26; steps += 4) {
        World *world = make_heap(steps);
        Reference reference = {0};
        ContactProblem problem = *solve_next(world, &reference);
        ContactPoint contacts[64];
        memcpy(contacts, problem.contacts, (size_t)problem.contact_count * sizeof *contacts);
        for (int i = 0; i < problem.contact_count; i++) {
            contacts[i].warm_normal = (float)reference.impulses[i].normal;
            contacts[i].warm_tangent = (float)reference.impulses[i].tangent;
        }
        problem.contacts = contacts;
        assert_fixed_point(&solver_sequential_impulses, "k=1", &problem, &reference);
        assert_fixed_point(&solver_sequential_impulses, "k=10", &problem, &reference);
        assert_fixed_point(&solver_over_relaxation, "k=10", &problem, &reference);
        assert_fixed_point(&solver_momentum, "k=10", &problem, &reference);
        assert_fixed_point(&solver_nncg, "k=10", &problem, &reference);
        assert_fixed_point(&solver_block, "k=10", &problem, &reference);
        assert_fixed_point(&solver_reference, "", &problem, &reference);
        reference_free(&reference);
        world_destroy(world);
    }
}

/* Every impulse of the reference pushes, stays in the cone and leaves no contact closing faster than its bias. */
static void the_reference_keeps_the_law_of_contact(void **state) {
    (void)state;
    World *world = make_heap(10);
    Reference reference = {0};
    const ContactProblem *problem = solve_next(world, &reference);
    Plain plain;
    memcpy(plain.velocities, reference.velocities, (size_t)problem->body_count * sizeof *reference.velocities);
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        double normal = reference.impulses[i].normal, tangent = reference.impulses[i].tangent;
        double limit = (double)contact->friction * normal, x = (double)contact->normal.x, y = (double)contact->normal.y;
        double opening = slip(&plain, contact, x, y) - (double)contact->bias, sliding = slip(&plain, contact, y, -x);
        assert_true(normal >= 0 && fabs(tangent) <= limit + 1e-12);
        assert_true(opening > -1e-9 && (normal == 0 || opening < 1e-9));
        if (sliding > 1e-9) assert_near(tangent, -limit, 1e-12);
        if (sliding < -1e-9) assert_near(tangent, limit, 1e-12);
    }
    reference_free(&reference);
    world_destroy(world);
}

/* What three sweeps leave is far from solved, and says so; more of them leave less, and begun from a solution there is
   nothing left to do. */
static void the_residual_tells_how_far_a_solve_got(void **state) {
    (void)state;
    World *world = make_heap(10);
    Reference reference = {0}, again = {0};
    const ContactProblem *problem = solve_next(world, &reference);
    Error error = {0};
    double last = INFINITY;
    for (int sweeps = 3; sweeps < 50; sweeps *= 4) {
        assert_ok(reference_solve(&again, problem, tight, sweeps * problem->contact_count, NULL, &error), error);
        assert_int_equal(again.sweeps, sweeps);
        assert_true(again.residual < 0.5 * last);
        if (sweeps == 3) assert_true(again.residual > 0.01);
        last = again.residual;
    }
    ContactImpulse start[64];
    for (int i = 0; i < problem->contact_count; i++)
        start[i] = (ContactImpulse){(float)reference.impulses[i].normal, (float)reference.impulses[i].tangent};
    assert_ok(reference_solve(&again, problem, 1e-4, VISITS, start, &error), error);
    assert_int_equal(again.sweeps, 2);
    assert_true(again.residual <= 1e-4);
    reference_free(&reference);
    reference_free(&again);
    world_destroy(world);
}

/* The residual is the largest |change of impulse| / effective mass of one more plain sweep. */
static void the_residual_is_what_a_plain_sweep_changes(void **state) {
    (void)state;
    World *world = make_heap(10);
    Reference reference = {0};
    const ContactProblem *problem = solve_next(world, &reference);
    Error error = {0};
    assert_ok(reference_solve(&reference, problem, tight, 5 * problem->contact_count, NULL, &error), error);
    Plain plain;
    memcpy(plain.velocities, reference.velocities, (size_t)problem->body_count * sizeof *reference.velocities);
    memcpy(plain.impulses, reference.impulses, (size_t)problem->contact_count * sizeof *reference.impulses);
    plain_sweep(&plain, problem);
    double largest = 0;
    for (int i = 0; i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        double normal = plain.impulses[i].normal - reference.impulses[i].normal;
        double tangent = plain.impulses[i].tangent - reference.impulses[i].tangent;
        largest = fmax(largest, fabs(normal) / (double)contact->mass_normal);
        largest = fmax(largest, fabs(tangent) / (double)contact->mass_tangent);
    }
    assert_near(reference.residual, largest, 1e-9 * largest);
    reference_free(&reference);
    world_destroy(world);
}

/* Static ground that moves at 0.1 m/s takes a box along: its friction could give it mu g dt = 0.17 m/s in the step. */
static void ground_that_moves_takes_a_box_along(void **state) {
    (void)state;
    World *world = make_world();
    add_body(world,
             &(BodyDef){.size = {100, 20}, .fixed = true, .friction = 1, .position = {0, -10}, .velocity = {0.1f, 0}});
    add_body(world, &(BodyDef){.size = {1, 1}, .mass = 3, .friction = 1, .position = {0, 0.5f}});
    Reference reference = {0};
    solve_next(world, &reference);
    assert_near(reference.velocities[0].x, 0.1f, 0);
    assert_near(reference.velocities[1].x, 0.1, 1e-7);
    assert_near(reference.velocities[1].y, 0, 1e-7);
    assert_near(fabs(reference.impulses[0].tangent + reference.impulses[1].tangent), 3 * 0.1, 1e-6);
    reference_free(&reference);
    world_destroy(world);
}

/* A plate that lies on more boxes than a sweep has rounds: together they carry it, and the ground them. */
static void a_plate_lies_on_very_many_boxes(void **state) {
    (void)state;
    enum { BOXES = 70 };
    World *world = make_world();
    add_ground(world, 0.2f);
    for (int i = 0; i < BOXES; i++)
        add_body(world,
                 &(BodyDef){.size = {0.5f, 1}, .mass = 1, .friction = 0.2f, .position = {0.6f * (float)i, 0.5f}});
    add_body(world, &(BodyDef){.size = {60, 1}, .mass = 500, .friction = 0.2f, .position = {0.3f * (BOXES - 1), 1.5f}});
    Reference reference = {0};
    ContactSolver engine = make_engine("k=1");
    run(world, &engine, 1);
    free_solver(&engine);
    const ContactProblem *problem = world_problem(world);
    assert_int_equal(problem->contact_count, 4 * BOXES);
    Error error = {0};
    assert_ok(reference_solve(&reference, problem, 1e-7, VISITS, NULL, &error), error);
    double on_ground = 0, on_boxes = 0, dt = (double)world_dt;
    for (int i = 0; i < problem->contact_count; i++)
        *(problem->contacts[i].a == 0 ? &on_ground : &on_boxes) += reference.impulses[i].normal;
    assert_near(on_boxes, 500 * g * dt, 0.01);
    assert_near(on_ground, (500 + BOXES) * g * dt, 0.01);
    reference_free(&reference);
    world_destroy(world);
}

static void nothing_that_touches_is_solved_at_once(void **state) {
    (void)state;
    World *world = make_world();
    add_body(world, &(BodyDef){.size = {1, 1}, .mass = 2, .position = {0, 9}, .velocity = {3, 0}});
    Reference reference = {0};
    solve_next(world, &reference);
    assert_true(reference.residual == 0);
    assert_near(reference.velocities[0].x, 3, 0);
    assert_near(reference.velocities[0].y, -g * (double)world_dt, 1e-7);
    reference_free(&reference);
    world_destroy(world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stack_on_ground_carries_its_weight),
        cmocka_unit_test(a_box_on_a_slope_sticks_below_the_friction_angle),
        cmocka_unit_test(boxes_that_crash_go_on_together),
        cmocka_unit_test(a_light_box_carries_a_heavy_one),
        cmocka_unit_test(many_plain_sweeps_find_the_same),
        cmocka_unit_test(the_reference_is_a_fixed_point_of_every_convergent_solver),
        cmocka_unit_test(the_reference_keeps_the_law_of_contact),
        cmocka_unit_test(the_residual_tells_how_far_a_solve_got),
        cmocka_unit_test(the_residual_is_what_a_plain_sweep_changes),
        cmocka_unit_test(ground_that_moves_takes_a_box_along),
        cmocka_unit_test(a_plate_lies_on_very_many_boxes),
        cmocka_unit_test(nothing_that_touches_is_solved_at_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
