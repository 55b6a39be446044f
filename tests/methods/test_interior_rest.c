/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method interior at rest: what must stand, stands, and does not creep. */
#include "kernels.h"
#include "reference_worlds.h"

/* Twenty boxes, and 1000:1 on one: momentum with 20 sweeps loses both. */
TEST(tall_and_heavy_stacks_stand) {
    World *tall = make_world(), *heavy = make_world();
    add_ground(tall, 0.2f);
    for (int i = 0; i < 20; i++)
        add_body(tall, &(BodyDef){.size = {1, 1}, .mass = 1, .friction = 0.2f, .position = {0, 0.5f + (float)i}});
    add_ground(heavy, 0.2f);
    for (int i = 0; i < 2; i++)
        add_body(heavy, &(BodyDef){.size = {1, 1},
                                   .mass = i == 0 ? 1.0f : 1000.0f,
                                   .friction = 0.2f,
                                   .position = {0, 0.5f + (float)i}});
    ContactSolver solver = make_solver(&solver_interior, "");
    run(tall, &solver, 1200);
    run(heavy, &solver, 1200);
    /* Each contact may close to the slop of 0.01 m. */
    assert_near(world_bodies(tall)[20].position.y, 19.5f, 0.2f);
    assert_near(world_bodies(tall)[20].position.x, 0, 0.02f);
    assert_near(world_bodies(heavy)[2].position.y, 1.5f, 0.02f);
    assert_near(world_bodies(heavy)[2].position.x, 0, 0.001f);
    free_solver(&solver);
    world_destroy(tall);
    world_destroy(heavy);
}

/* The largest distance by which a body moves in the next steps, m. */
static double moved(World *world, const ContactSolver *solver, int steps) {
    Body before[32];
    const int count = world_body_count(world);
    assert_in_range(count, 1, 32);
    memcpy(before, world_bodies(world), (size_t)count * sizeof *before);
    run(world, solver, steps);
    double most = 0;
    for (int i = 0; i < count; i++) {
        const Vec2 by = vec2_sub(world_bodies(world)[i].position, before[i].position);
        most = fmax(most, hypot((double)by.x, (double)by.y));
    }
    return most;
}

/* After 20 s at rest a stack is still: errors do not add up from step to step. An error of the tolerance in each step
   would make 1 mm in 10 s. */
TEST(stacks_at_rest_stay_in_place) {
    static const int heights[] = {1, 9, 20};
    for (int k = 0; k < 3; k++) {
        World *world = make_world();
        add_ground(world, 0.2f);
        for (int i = 0; i < heights[k]; i++) add_box(world, 1, 0.2f, vec2(0, 0.5f + (float)i));
        ContactSolver solver = make_solver(&solver_interior, "");
        run(world, &solver, 1200);
        assert_true(moved(world, &solver, 600) < 1e-6);
        free_solver(&solver);
        world_destroy(world);
    }
}

/* Stacks that do not touch do not depend on each other: eight of 20 stand as one does. */
TEST(many_stacks_stand_as_one_does) {
    World *world = make_world();
    add_ground(world, 0.2f);
    for (int k = 0; k < 8; k++)
        for (int i = 0; i < 20; i++) add_box(world, 1, 0.2f, vec2(5 * (float)(k - 4), 0.5f + (float)i));
    ContactSolver solver = make_solver(&solver_interior, "");
    run(world, &solver, 900);
    for (int k = 0; k < 8; k++) {
        const Body *top = &world_bodies(world)[20 * (k + 1)];
        assert_near(top->position.x, 5 * (float)(k - 4), 0.05f);
        assert_near(top->position.y, 19.5f, 0.2f);
    }
    free_solver(&solver);
    world_destroy(world);
}

/* Friction holds a box on a slope if and only if the slope is less than the friction; then the box is
   still, but for a micrometre per second next to the limit. */
TEST(a_box_that_friction_holds_does_not_creep) {
    static const float slopes[] = {0.1f, 0.19f, 0.199f};
    for (int k = 0; k < 3; k++) {
        const WorldDef def = {.gravity = {10 * slopes[k], -10}, .warm_starting = true, .position_correction = true};
        World *world = world_create(&def, &error);
        assert_ok(world != NULL, error);
        add_ground(world, 0.2f);
        add_box(world, 1, 0.2f, vec2(0, 0.5f));
        ContactSolver solver = make_solver(&solver_interior, "");
        run(world, &solver, 120);
        assert_true(moved(world, &solver, 600) < 1e-5);
        free_solver(&solver);
        world_destroy(world);
    }
}

RUN_TESTS(NULL, NULL)
