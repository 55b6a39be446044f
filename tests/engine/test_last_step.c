/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contact problem of the last step and its solution stay valid when bodies are added after it: the bomb comes
   then. */
#include "owned.h"

#include "engine/engine.h"

enum { BODIES = 16, ADDED = 1000, BLOCKS = 64 };

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    (void)state, (void)error;
    for (int i = 0; i < problem->body_count; i++)
        solution->velocities[i] = (BodyVelocity){problem->bodies[i].velocity, problem->bodies[i].angular_velocity};
    for (int i = 0; i < problem->contact_count; i++) solution->impulses[i] = (ContactImpulse){0};
    return true;
}

static void add_box(World *world, float x) {
    Error error = {0};
    const BodyDef box = {.size = {1, 1}, .mass = 1, .friction = 0.2f, .position = {x, 3}};
    assert_ok(world_add_body(world, &box, &error), error);
}

TEST(a_problem_outlives_added_bodies) {
    OWN(World) *world = world_create(&(WorldDef){.gravity = {0, -10}}, &error);
    assert_ok(world != NULL, error);
    for (int i = 0; i < BODIES; i++) add_box(world, 2.0f * (float)i);
    assert_ok(world_step(world, solve, NULL, 0.1f, &error), error);
    for (int i = 0; i < ADDED; i++) add_box(world, -2.0f * (float)(i + 1));
    /* What was freed is overwritten. */
    void *blocks[BLOCKS];
    for (size_t i = 0; i < BLOCKS; i++) {
        const size_t size = 64 * (i + 1);
        blocks[i] = malloc(size);
        assert_non_null(blocks[i]);
        memset(blocks[i], 0xff, size);
    }
    const ContactProblem *problem = world_problem(world);
    const ContactSolution *solution = world_solution(world);
    assert_int_equal(problem->body_count, BODIES);
    for (int i = 0; i < BODIES; i++) {
        assert_near(problem->bodies[i].position.x, 2.0f * (float)i, 0);
        assert_near(problem->bodies[i].velocity.y, -1, 1e-6);
        assert_near(solution->velocities[i].linear.y, -1, 1e-6);
    }
    for (int i = 0; i < BLOCKS; i++) free(blocks[i]);
}

RUN_TESTS(NULL, NULL)
