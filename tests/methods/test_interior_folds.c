/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method interior where its iterations fail: at impacts whose central path turns back. */
#include "allocations.h"
#include "consistent.h"
#include "kernels.h"
#include "reference_worlds.h"

#include <limits.h>

enum { COURSES = 7, PER_COURSE = 7 };

static Reference reference;

/* A brick wall in half-brick bond, `steps` steps after a box of many times a brick's mass has reached it. */
static World *make_struck_wall(float x, float angle, int steps) {
    World *world = make_world();
    add_ground(world, 0.5f);
    BodyDef brick = {.size = {1.5f, 1}, .mass = 4, .friction = 0.5f};
    for (int course = 0; course < COURSES; course++)
        for (int i = 0; i < PER_COURSE - course % 2; i++) {
            brick.position = vec2(1.5f * (float)i + 0.75f * (float)(course % 2) - 0.75f * (float)(PER_COURSE - 1),
                                  0.495f + 0.99f * (float)course);
            add_body(world, &brick);
        }
    add_body(world, &(BodyDef){.size = {1.2f, 1.2f},
                               .mass = 70,
                               .friction = 0.5f,
                               .position = {x, 0.99f * (float)COURSES + 0.8f},
                               .angle = angle,
                               .velocity = {-1.3f * x, -17}});
    run_engine(world, "", steps);
    return world;
}

/* The largest change by one more visit of a contact, m/s. */
static double residual_of(const ContactProblem *problem, const ContactSolution *found) {
    Error error = {0};
    double residual = INFINITY;
    assert_ok(reference_residual(&reference, problem, found->impulses, &residual, &error), error);
    return residual;
}

/* Iterations alone leave two of five of these to sweeps, with errors of 0.02 to 0.1 m/s. */
TEST(struck_walls_need_no_sweeps) {
    int problems = 0, by_sweeps = 0;
    for (int i = -8; i <= 8; i += 2)
        for (int k = 0; k < 5; k++) {
            World *world = make_struck_wall(0.5f * (float)i + 0.1f, 0.3f * (float)k, 1);
            const ContactProblem *problem = next_problem(world);
            ContactSolution found = make_solution(problem);
            solve_with(&solver_interior, "near=0.001", problem, &found);
            problems++;
            by_sweeps += found.fallbacks.by_sweeps;
            if (found.fallbacks.by_sweeps == 0) assert_true(residual_of(problem, &found) < 0.02);
            assert_velocities_fit(problem, &found);
            free_solution(&found);
            world_destroy(world);
        }
    if (problems != 45 || by_sweeps > 1) fail_msg("%d of %d by sweeps", by_sweeps, problems);
}

/* Position correction pushes the box out of both walls, which no impulses can. */
TEST(a_step_without_a_solution_falls_back) {
    World *world = make_world();
    for (int i = -1; i <= 1; i += 2)
        add_body(world, &(BodyDef){.size = {1, 3}, .fixed = true, .friction = 0.5f, .position = {(float)i, 0}});
    add_body(world, &(BodyDef){.size = {1.2f, 1}, .mass = 1, .friction = 0.5f, .position = {0, 0}});
    const ContactProblem *problem = next_problem(world);
    ContactSolution found = make_solution(problem);
    solve_with(&solver_interior, "near=0.001", problem, &found);
    assert_int_equal(found.fallbacks.by_sweeps, 1);
    assert_velocities_fit(problem, &found);
    for (int i = 0; i < problem->contact_count; i++) assert_true(found.impulses[i].normal < 1e3f);
    free_solution(&found);
    world_destroy(world);
}

/* After a problem of the same size that iterations solve: a softer impact. */
TEST(the_path_allocates_nothing) {
    enum { BODIES_MAX = 64 };
    World *world = make_struck_wall(-3.9f, 0.9f, 1);
    const ContactProblem *struck = next_problem(world);
    ContactProblem calm = *struck;
    ProblemBody bodies[BODIES_MAX];
    assert_in_range(struck->body_count, 3, BODIES_MAX);
    memcpy(bodies, struck->bodies, (size_t)struck->body_count * sizeof *bodies);
    for (int i = 0; i < struck->body_count; i++) {
        bodies[i].velocity = vec2_scale(0.2f, bodies[i].velocity);
        bodies[i].angular_velocity *= 0.2f;
    }
    calm.bodies = bodies;
    ContactSolution found = make_solution(struck);
    ContactSolver solver = make_solver(&solver_interior, "near=0.001");
    assert_ok(solver.kind->solve(solver.state, &calm, &found, &error), error);
    allocations = 0;
    assert_ok(solver.kind->solve(solver.state, struck, &found, &error), error);
    assert_int_equal(allocations, 0);
    free_solver(&solver);
    free_solution(&found);
    world_destroy(world);
}

/* The reference ends as soon as asked to. */
TEST(the_path_ends_at_the_tolerance) {
    World *world = make_struck_wall(2.1f, 0.3f, 1);
    const ContactProblem *problem = next_problem(world);
    assert_ok(reference_solve_to(&reference, problem, 0.01, INT_MAX, &error), error);
    const int rough = reference.factorizations;
    assert_true(reference.residual <= 0.01);
    assert_ok(reference_solve(&reference, problem, NULL, &error), error);
    assert_true(rough < reference.factorizations);
    assert_ok(reference_solve_to(&reference, problem, 1e-9, 5, &error), error);
    assert_true(reference.factorizations <= 5 + 2);
    assert_true(reference.residual > 1e-9);
    world_destroy(world);
}

FIXTURE(free_reference) { reference_free(&reference); }

RUN_TESTS(NULL, free_reference)
