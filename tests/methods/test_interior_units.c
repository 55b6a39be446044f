/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method interior in other units: nothing that it does depends on how heavy, large or slow the bodies are, or on
   gravity and the time step. Factors are powers of two, so that equal steps have equal bits. */
#include "kernels.h"
#include "reference_worlds.h"

#include "methods/islands.h"
#include "methods/residual.h"

enum { BODIES_MAX = 64, CONTACTS_MAX = 256 };

typedef struct Scaled {
    ContactProblem problem;
    ProblemBody bodies[BODIES_MAX];
    ContactPoint contacts[CONTACTS_MAX];
} Scaled;

/* Masses times `mass`; speeds and times times `speed`, lengths times its square: accelerations stay. */
static void scale(Scaled *to, const ContactProblem *from, float mass, float speed) {
    const float length = speed * speed;
    assert_in_range(from->body_count, 1, BODIES_MAX);
    assert_in_range(from->contact_count, 1, CONTACTS_MAX);
    to->problem = *from;
    to->problem.dt *= speed;
    to->problem.fall *= speed;
    to->problem.bodies = to->bodies;
    to->problem.contacts = to->contacts;
    for (int i = 0; i < from->body_count; i++) {
        ProblemBody *body = &to->bodies[i];
        *body = from->bodies[i];
        body->inv_mass /= mass;
        body->inv_inertia /= mass * length * length;
        body->velocity = vec2_scale(speed, body->velocity);
        body->angular_velocity /= speed;
    }
    for (int i = 0; i < from->contact_count; i++) {
        ContactPoint *contact = &to->contacts[i];
        *contact = from->contacts[i];
        contact->position = vec2_scale(length, contact->position);
        contact->arm_a = vec2_scale(length, contact->arm_a);
        contact->arm_b = vec2_scale(length, contact->arm_b);
        contact->separation *= length;
        contact->mass_normal *= mass;
        contact->mass_tangent *= mass;
        contact->bias *= speed;
        contact->warm_normal *= mass * speed;
        contact->warm_tangent *= mass * speed;
    }
}

static void expect_same_bits(const ContactProblem *problem, float mass, float speed) {
    static Scaled scaled;
    scale(&scaled, problem, mass, speed);
    const char *near = printed("near=%.9g", 0.001 * (double)speed);
    OWN(ContactSolution) found = make_solution(problem), other = make_solution(problem);
    solve_with(&solver_interior, "near=0.001", problem, &found);
    solve_with(&solver_interior, near, &scaled.problem, &other);
    assert_int_equal(found.fallbacks.by_sweeps, other.fallbacks.by_sweeps);
    for (int i = 0; i < problem->body_count; i++) {
        const BodyVelocity *v = &found.velocities[i], *w = &other.velocities[i];
        if (w->linear.x != speed * v->linear.x || w->linear.y != speed * v->linear.y ||
            w->angular * speed != v->angular)
            fail_msg("masses times %g, speeds times %g: body %d at %.9g, %.9g for %.9g, %.9g", (double)mass,
                     (double)speed, i, (double)w->linear.x, (double)w->linear.y, (double)v->linear.x,
                     (double)v->linear.y);
    }
}

/* A wall of bricks, `steps` steps after a box of `mass` has reached it. */
static World *make_wall(float mass, float speed, int steps) {
    World *world = make_world();
    add_ground(world, 0.5f);
    for (int course = 0; course < 6; course++)
        for (int i = 0; i < 6 - course % 2; i++)
            add_body(world, &(BodyDef){.size = {1.5f, 1},
                                       .mass = 4,
                                       .friction = 0.5f,
                                       .position = {1.5f * (float)i + 0.75f * (float)(course % 2),
                                                    0.495f + 0.99f * (float)course}});
    add_body(world, &(BodyDef){.size = {1.2f, 1.2f},
                               .mass = mass,
                               .friction = 0.5f,
                               .position = {3, 6.5f},
                               .angle = 0.3f,
                               .velocity = {-2, -speed}});
    run_engine(world, "", steps);
    return world;
}

/* Whether no island is at rest, where speeds are measured by the slop. */
static bool is_struck(const ContactProblem *problem) {
    Islands islands = {0};
    float fastest[BODIES_MAX] = {0};
    assert_true(islands_find(&islands, problem));
    for (int i = 0; i < problem->contact_count; i++)
        fastest[islands.island[i]] = fmaxf(fastest[islands.island[i]], sqrtf(residual_of_motion(problem, i)));
    bool struck = true;
    for (int k = 0; k < islands.count; k++) struck = struck && fastest[k] > 2;
    islands_free(&islands);
    return struck;
}

/* Lengths can only change in impacts: at rest contacts close to a share of the slop, which is the engine's. Among these
   are impacts that sweeps end, that quick iterations solve, that others solve, and that none does. */
TEST(impacts_in_other_units_have_the_same_bits) {
    static const float masses[] = {4, 70, 40000};
    int struck = 0;
    for (int k = 0; k < 3; k++)
        for (int steps = 0; steps < 6; steps++) {
            OWN(World) *world = make_wall(masses[k], 20, steps);
            const ContactProblem *problem = next_problem(world);
            expect_same_bits(problem, 0x1p14f, 1);
            expect_same_bits(problem, 0x1p-14f, 1);
            if (is_struck(problem)) {
                expect_same_bits(problem, 1, 8);
                expect_same_bits(problem, 0x1p-10f, 2);
                struck++;
            }
        }
    assert_true(struck >= 9);
}

TEST(rest_in_other_masses_has_the_same_bits) {
    for (int steps = 0; steps < 40; steps += 3) {
        OWN(World) *world = make_wall(40, 0, steps);
        const ContactProblem *problem = next_problem(world);
        expect_same_bits(problem, 0x1p14f, 1);
        expect_same_bits(problem, 0x1p-14f, 1);
    }
}

/* m: how far boxes of a pyramid move in the last of 20 s of steps of dt (s) under this gravity (m/s^2). */
static double moved_at_rest(int rows, float gravity, float dt) {
    Error error = {0};
    const WorldDef def = {.gravity = {0, -gravity}, .warm_starting = true, .position_correction = true};
    OWN(World) *world = world_create(&def, &error);
    assert_ok(world != NULL, error);
    add_ground(world, 0.5f);
    for (int row = 0; row < rows; row++)
        for (int i = row; i < rows; i++) add_box(world, 1, 0.5f, vec2((float)i - 0.5f * (float)row, 0.5f + (float)row));
    OWN(ContactSolver) solver = make_solver(&solver_interior, "");
    Vec2 before[BODIES_MAX];
    const int count = world_body_count(world), steps = (int)(20 / dt), last = (int)(1 / dt);
    assert_in_range(count, 2, BODIES_MAX);
    double most = 0;
    for (int step = 0; step < steps; step++) {
        if (step == steps - last)
            for (int i = 0; i < count; i++) before[i] = world_bodies(world)[i].position;
        assert_ok(world_step(world, solver.kind->solve, solver.state, dt, &error), error);
    }
    for (int i = 0; i < count; i++) {
        const Vec2 by = vec2_sub(world_bodies(world)[i].position, before[i]);
        most = fmax(most, hypot((double)by.x, (double)by.y));
    }
    return most;
}

/* At 8 Hz, or under Jupiter's gravity at 20 Hz, a step of gravity makes 1.25 m/s: a speed from which impacts were told,
   and solved to a tolerance at which the pyramid sank, and the box jumped. */
TEST(boxes_rest_at_long_steps_and_under_any_gravity) {
    static const struct {
        int rows;
        float gravity, dt;
    } cases[] = {{1, 10, 0.125f},   {3, 10, 0.125f},      {6, 10, 0.125f},
                 {6, 24.8f, 0.05f}, {6, 1.6f, 1.0f / 60}, {6, 0.01f, 1.0f / 60}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double by = moved_at_rest(cases[i].rows, cases[i].gravity, cases[i].dt);
        if (!(by < 1e-4))
            fail_msg("%d rows, %g m/s^2, %g s: %g m", cases[i].rows, (double)cases[i].gravity, (double)cases[i].dt, by);
    }
}

RUN_TESTS(NULL, NULL)
