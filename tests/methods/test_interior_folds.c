/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method interior where its iterations fail: at impacts whose central path turns back; and the work that this
   takes. The reference follows such paths. */
#include "allocations.h"
#include "consistent.h"
#include "kernels.h"
#include "reference_worlds.h"

#include "methods/interior_point_internal.h"

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

static double error_of(const ContactSolverKind *kind, const char *settings, const ContactProblem *problem) {
    OWN(ContactSolution) found = make_solution(problem);
    solve_with(kind, settings, problem, &found);
    const double error = solution_error(problem, found.velocities, reference.velocities).rms;
    if (kind == &solver_interior) assert_velocities_fit(problem, &found, false);
    return error;
}

/* The path of each turns back: few converge within the work that a step may take. Iterations and sweeps from their best
   answer leave less than sweeps of the same work. */
TEST(struck_walls_are_solved_better_than_by_sweeps_of_the_same_work) {
    double gain = 0;
    int problems = 0;
    for (int i = -8; i <= 8; i += 2)
        for (int k = 0; k < 5; k++) {
            OWN(World) *world = make_struck_wall(0.5f * (float)i + 0.1f, 0.3f * (float)k, 1);
            const ContactProblem *problem = next_problem(world);
            assert_ok(reference_solve(&reference, problem, NULL, &error), error);
            if (reference_converged(&reference)) {
                problems++;
                gain += log(error_of(&solver_momentum, "k=20,near=1e-9,more=176", problem) /
                            error_of(&solver_interior, "", problem));
            }
        }
    if (problems < 40 || exp(gain / problems) < 1.2) fail_msg("%d problems, gain %g", problems, exp(gain / problems));
}

/* Position correction pushes the box out of both walls, which no impulses can. */
TEST(a_step_without_a_solution_falls_back) {
    OWN(World) *world = make_world();
    for (int i = -1; i <= 1; i += 2)
        add_body(world, &(BodyDef){.size = {1, 3}, .fixed = true, .friction = 0.5f, .position = {(float)i, 0}});
    add_body(world, &(BodyDef){.size = {1.2f, 1}, .mass = 1, .friction = 0.5f, .position = {0, 0}});
    const ContactProblem *problem = next_problem(world);
    OWN(ContactSolution) found = make_solution(problem);
    solve_with(&solver_interior, "near=0.001", problem, &found);
    assert_int_equal(found.fallbacks.by_sweeps, 1);
    assert_velocities_fit(problem, &found, false);
    for (int i = 0; i < problem->contact_count; i++) assert_true(found.impulses[i].normal < 1e3f);
}

/* After a problem of the same size that iterations solve: a softer impact. */
TEST(a_hard_impact_allocates_nothing) {
    enum { BODIES_MAX = 64 };
    OWN(World) *world = make_struck_wall(-3.9f, 0.9f, 1);
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
    OWN(ContactSolution) found = make_solution(struck);
    OWN(ContactSolver) solver = make_solver(&solver_interior, "near=0.001");
    assert_ok(solver.kind->solve(solver.state, &calm, &found, &error), error);
    allocations = 0;
    assert_ok(solver.kind->solve(solver.state, struck, &found, &error), error);
    assert_int_equal(allocations, 0);
}

TEST(the_reference_ends_at_the_tolerance) {
    OWN(World) *world = make_struck_wall(2.1f, 0.3f, 1);
    const ContactProblem *problem = next_problem(world);
    assert_ok(reference_solve_to(&reference, problem, &(ReferenceAim){0.01, INT_MAX, true, false}, &error), error);
    const int rough = reference.factorizations;
    assert_true(reference.residual <= 0.01);
    assert_ok(reference_solve(&reference, problem, NULL, &error), error);
    assert_true(rough < reference.factorizations);
    assert_ok(reference_solve_to(&reference, problem, &(ReferenceAim){1e-9, 5, true, false}, &error), error);
    assert_true(reference.factorizations <= 5 + 2);
    assert_true(reference.residual > 1e-9);
}

/* A pyramid of 36 boxes of 1 kg, just before a box of `mass` reaches it. */
static World *make_struck_pyramid(float mass, float x) {
    World *world = make_world();
    add_ground(world, 0.5f);
    for (int row = 0; row < 8; row++)
        for (int i = row; i < 8; i++)
            add_box(world, 1, 0.5f, vec2((float)i - 0.5f * (float)row, 0.495f + 0.99f * (float)row));
    add_body(world,
             &(BodyDef){.size = {1, 1}, .mass = mass, .friction = 0.5f, .position = {x, 8.5f}, .velocity = {0, -14}});
    return world;
}

static const float heavy_at[] = {-2.3f, 0.4f, 3.2f, 5.1f}; /* m */

/* Measured by the boxes' own masses iterations begin far from what a heavy body passes on, and all steps of the impact
   end in sweeps, with errors of metres per second. Here all steps count in which sweeps of about the same time leave
   some. */
TEST(heavy_bodies_are_no_hindrance) {
    for (float mass = 100; mass < 2e5f; mass *= 10) {
        double gain = 0;
        int problems = 0;
        for (int i = 0; i < 4 * 12; i++) {
            OWN(World) *world = make_struck_pyramid(mass, heavy_at[i / 12]);
            run_engine(world, "", i % 12);
            const ContactProblem *problem = next_problem(world);
            assert_ok(reference_solve(&reference, problem, NULL, &error), error);
            const double rival = error_of(&solver_momentum, "k=150", problem);
            if (!reference_converged(&reference) || rival < 0.1) continue;
            problems++;
            gain += log(rival / fmax(error_of(&solver_interior, "", problem), 1e-5));
        }
        if (problems < 10 || exp(gain / problems) < 5)
            fail_msg("%g kg: %d steps, gain %g", (double)mass, problems, exp(gain / problems));
    }
}

/* Steps by the method lead on until the pyramid has come down. */
TEST(work_has_a_bound) {
    double largest = 0;
    for (float mass = 10; mass < 2e9f; mass *= 10) {
        OWN(World) *world = make_struck_pyramid(mass, 3.2f);
        OWN(ContactSolver) solver = make_solver(&solver_interior, "");
        for (int step = 0; step < 60; step++) {
            assert_ok(world_step(world, solver.kind->solve, solver.state, world_dt, &error), error);
            largest = fmax(largest, interior_work_done(solver.state));
        }
        for (int i = 1; i <= 36; i++) assert_true(world_bodies(world)[i].position.y > 0.4f);
    }
    if (largest > INTERIOR_MOST_WORK || largest < 0.8 * INTERIOR_MOST_WORK) fail_msg("work %g", largest);
}

FIXTURE(free_reference) { reference_free(&reference); }

RUN_TESTS(NULL, free_reference)
