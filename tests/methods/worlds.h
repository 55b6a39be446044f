/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small worlds, made by hand, and the engine to run them. */
#pragma once
#include "owned.h"

#include "engine/engine.h"
#include "methods/methods.h"

static const float world_dt = 1.0f / 60.0f;

/* A BodyVelocity is this within the tolerance. */
#define assert_velocity(actual_velocity, along_x, along_y, spin, tolerance) \
    do {                                                                    \
        assert_near((actual_velocity).linear.x, (along_x), (tolerance));    \
        assert_near((actual_velocity).linear.y, (along_y), (tolerance));    \
        assert_near((actual_velocity).angular, (spin), (tolerance));        \
    } while (0)

static inline void assert_velocities(const BodyVelocity *found, const BodyVelocity *expected, int count,
                                     double tolerance) {
    for (int i = 0; i < count; i++)
        assert_velocity(found[i], expected[i].linear.x, expected[i].linear.y, expected[i].angular, tolerance);
}

/* A solver with these settings ("k=10"). */
static inline ContactSolver make_solver(const ContactSolverKind *kind, const char *text) {
    Error error = {0};
    Settings settings;
    assert_ok(settings_parse(&settings, text, kind->description.settings, kind->description.name, &error), error);
    ContactSolver solver = {kind, kind->create(&settings, &error)};
    assert_ok(solver.state != NULL, error);
    return solver;
}

/* create() refuses these settings, with a message that contains the text. */
static inline void assert_settings_refused(const ContactSolverKind *kind, const char *text, const char *message) {
    Error error = {0};
    Settings settings;
    assert_ok(settings_parse(&settings, text, kind->description.settings, kind->description.name, &error), error);
    assert_refused(kind->create(&settings, &error), message);
}

static inline ContactSolver make_engine(const char *text) { return make_solver(&solver_engine, text); }

static inline void free_solver(ContactSolver *solver) { solver->kind->destroy(solver->state); }

OWNED_VALUE(ContactSolver, free_solver)

/* Solves a problem by a solver made for this once. */
static inline void solve_with(const ContactSolverKind *kind, const char *text, const ContactProblem *problem,
                              ContactSolution *solution) {
    Error error = {0};
    ContactSolver solver = make_solver(kind, text);
    assert_ok(kind->solve(solver.state, problem, solution, &error), error);
    free_solver(&solver);
}

static inline World *make_world(void) {
    Error error = {0};
    const WorldDef def = {.gravity = {0, -10}, .warm_starting = true, .position_correction = true};
    World *world = world_create(&def, &error);
    assert_ok(world != NULL, error);
    return world;
}

static inline void add_body(World *world, const BodyDef *def) {
    Error error = {0};
    assert_ok(world_add_body(world, def, &error), error);
}

/* A box of unit size at rest. */
static inline void add_box(World *world, float mass, float friction, Vec2 position) {
    add_body(world, &(BodyDef){.size = {1, 1}, .mass = mass, .friction = friction, .position = position});
}

/* The ground of the paper's scenes: its top at y = 0. */
static inline void add_ground(World *world, float friction) {
    const BodyDef ground = {.size = {100, 20}, .fixed = true, .friction = friction, .position = {0, -10}};
    add_body(world, &ground);
}

/* A wide box that slides fast: friction is at its limit, mu times what the ground holds. */
static inline World *make_sliding_box(void) {
    World *world = make_world();
    add_ground(world, 0.5f);
    add_body(world,
             &(BodyDef){.size = {10, 1}, .mass = 1, .friction = 0.5f, .position = {0, 0.495f}, .velocity = {9, 0}});
    return world;
}

/* A box of 1 kg on the ground carries a heavy one; their positions are those of the first contacts or of rest. */
static inline World *make_heavy_on_light(float heavy, float light_at, float heavy_at) {
    World *world = make_world();
    add_ground(world, 0.2f);
    add_box(world, 1, 0.2f, vec2(0, light_at));
    add_box(world, heavy, 0.2f, vec2(0, heavy_at));
    return world;
}

static inline void run(World *world, const ContactSolver *solver, int steps) {
    Error error = {0};
    world_set_contacts(world, (ContactRules){.mend = !solver->kind->description.lite_contacts});
    for (int i = 0; i < steps; i++)
        assert_ok(world_step(world, solver->kind->solve, solver->state, world_dt, &error), error);
}

/* Steps by the engine with these settings ("k=10"). */
static inline void run_engine(World *world, const char *settings, int steps) {
    ContactSolver engine = make_engine(settings);
    run(world, &engine, steps);
    free_solver(&engine);
}

/* The contact problem that the world's next step meets. The engine makes the step. */
static inline const ContactProblem *next_problem(World *world) {
    run_engine(world, "k=1", 1);
    return world_problem(world);
}
