/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method interior at rest: what must stand, stands, and does not creep. */
#include "kernels.h"
#include "made.h"
#include "random_structures.h"
#include "reference_worlds.h"

#include "methods/interior_point_internal.h"

/* The largest distance by which a body moves in the next steps, m. */
static double moved(World *world, const ContactSolver *solver, int steps) {
    Body before[64];
    const int count = world_body_count(world);
    assert_in_range(count, 1, 64);
    memcpy(before, world_bodies(world), (size_t)count * sizeof *before);
    run(world, solver, steps);
    double most = 0;
    for (int i = 0; i < count; i++) {
        const Vec2 by = vec2_sub(world_bodies(world)[i].position, before[i].position);
        most = fmax(most, hypot((double)by.x, (double)by.y));
    }
    return most;
}

/* Errors do not add up from step to step: in 10 s the top of a stack moves by less than the tolerances of its boxes
   together (fine_near of the speed after a fall through five slops) times that time. */
TEST(stacks_at_rest_stay_in_place) {
    static const int heights[] = {1, 9, 20, 34, 60};
    for (int k = 0; k < 5; k++) {
        OWN(World) *world = make_world();
        add_ground(world, 0.2f);
        for (int i = 0; i < heights[k]; i++) add_box(world, 1, 0.2f, vec2(0, 0.5f + (float)i));
        OWN(ContactSolver) solver = make_solver(&solver_interior, "");
        run(world, &solver, 1200);
        const double by = moved(world, &solver, 600);
        if (!(by < 1e-5 * sqrt(10 * CONTACT_SLOP * 10) * 10)) fail_msg("%d boxes moved by %g m", heights[k], by);
    }
}

/* Structures whose bodies have 1 to a million times each other's mass, all of which the reference holds: a light box
   below a heavy one must not let it tip. */
TEST(light_boxes_carry_heavy_ones) {
    static const int seeds[] = {7012, 7078,  7102,  7116,  7180,  7266,  7392,  7442,
                                7464, 20018, 20390, 20446, 20740, 21408, 22008, 30366};
    for (size_t k = 0; k < sizeof seeds / sizeof *seeds; k++) {
        OWN(Scene) *scene = random_structure(seeds[k]);
        OWN(World) *world = world_of(scene);
        world_set_contacts(world, (ContactRules){.mend = true});
        OWN(ContactSolver) solver = make_solver(&solver_interior, "");
        run(world, &solver, 600);
        const float unit = scene->bodies[0].size.x / 500;
        for (int i = 1; i < scene->body_count; i++) {
            const Vec2 by = vec2_sub(world_bodies(world)[i].position, scene->bodies[i].position);
            const double distance = hypot((double)by.x, (double)by.y) / (double)unit;
            if (!(distance < 0.1)) fail_msg("%s: body %d moved by %g of its side", scene->name, i, distance);
        }
    }
}

/* At 209 m positions round to 15 micrometres, which no contact can close by. Each box that was told to moved on in
   every step. */
TEST(a_pyramid_far_from_the_origin_comes_to_rest) {
    OWN(World) *world = make_world();
    add_body(world, &(BodyDef){.size = {40, 1}, .fixed = true, .friction = 0.6f, .position = {0, 208.5f}});
    for (int row = 0; row < 7; row++)
        for (int i = 0; i < 7 - row; i++)
            add_box(world, 1, 0.6f, vec2((float)i + 0.5f * (float)row, 209.5f + (float)row));
    OWN(ContactSolver) solver = make_solver(&solver_interior, "");
    run(world, &solver, 300);
    float fastest = 0;
    for (int step = 0; step < 60; step++) {
        run(world, &solver, 1);
        for (int i = 0; i < world_body_count(world); i++)
            fastest = fmaxf(fastest, fabsf(world_bodies(world)[i].velocity.x));
    }
    if (!(fastest < 1e-5f)) fail_msg("%g m/s", (double)fastest);
}

/* Friction holds a box on a slope if and only if the slope is less than the friction; then the box is
   still, but for a micrometre per second next to the limit. */
TEST(a_box_that_friction_holds_does_not_creep) {
    static const float slopes[] = {0.1f, 0.19f, 0.199f};
    for (int k = 0; k < 3; k++) {
        const WorldDef def = {.gravity = {10 * slopes[k], -10}, .warm_starting = true, .position_correction = true};
        OWN(World) *world = world_create(&def, &error);
        assert_ok(world != NULL, error);
        add_ground(world, 0.2f);
        add_box(world, 1, 0.2f, vec2(0, 0.5f));
        OWN(ContactSolver) solver = make_solver(&solver_interior, "");
        run(world, &solver, 120);
        assert_true(moved(world, &solver, 600) < 1e-5);
    }
}

/* A pyramid of that many rows, spaced by `width`. */
static void add_pyramid(World *world, int rows, float width, float friction) {
    for (int row = 0; row < rows; row++)
        for (int i = 0; i < rows - row; i++)
            add_box(world, 5, friction, vec2(width * ((float)i - 0.5f * (float)(rows - 1 - row)), 0.5f + (float)row));
}

/* Bricks of 1.6 m in half-brick bond, that touch. */
static void add_wall(World *world, int courses, int per_course, float friction) {
    for (int course = 0; course < courses; course++)
        for (int i = 0; i <= per_course; i++) {
            const bool odd = course % 2 == 1, half = odd && (i == 0 || i == per_course);
            if (!odd && i == per_course) continue;
            const float middle = odd ? (float)i - 0.5f : (float)i, shift = !half ? 0 : i == 0 ? 0.25f : -0.25f;
            add_body(world, &(BodyDef){.size = {half ? 0.8f : 1.6f, 0.8f},
                                       .mass = half ? 3 : 6,
                                       .friction = friction,
                                       .position = {1.6f * (middle + shift - 0.5f * (float)(per_course - 1)),
                                                    0.4f + 0.8f * (float)course}});
        }
}

/* Boxes of 1 and 100 kg in turns, pressed together between walls: impulses that nothing limits are there from the
   start. */
static void add_jam(World *world) {
    for (int side = -1; side <= 1; side += 2)
        add_body(world, &(BodyDef){.size = {1, 10}, .fixed = true, .friction = 1, .position = {3 * (float)side, 5}});
    for (int row = 0; row < 8; row++)
        for (int i = 0; i < 5; i++)
            add_body(world, &(BodyDef){.size = {1.003f, 1},
                                       .mass = (row + i) % 2 == 0 ? 1 : 100,
                                       .friction = 1,
                                       .position = {(float)(i - 2), 0.5f + (float)row}});
}

/* Of any body, from where it began, sideways, m. */
static double shifted(const World *world, const Body *before) {
    double most = 0;
    for (int i = 0; i < world_body_count(world); i++)
        most = fmax(most, fabs((double)(world_bodies(world)[i].position.x - before[i].position.x)));
    return most;
}

/* For 10 s no body moves by `most` m sideways, nor overlaps by more than `overlap`. */
static void assert_stands(World *world, double most, double overlap) {
    const int count = world_body_count(world);
    FREED Body *before = malloc((size_t)count * sizeof *before);
    assert_non_null(before);
    memcpy(before, world_bodies(world), (size_t)count * sizeof *before);
    OWN(ContactSolver) solver = make_solver(&solver_interior, "");
    run(world, &solver, 600);
    const double by = shifted(world, before);
    if (!(by < most && world_penetration(world) < overlap))
        fail_msg("%d bodies: %g m sideways, overlap %g m", count, by, world_penetration(world));
    world_destroy(world);
}

/* Many boxes, with loops between them, beside each other or apart; light below heavy; without friction; jammed.
   Contacts that open once let all of them fall: a pyramid of 20 rows fell by 0.5 m. */
TEST(what_stands_on_many_contacts_stays_closed) {
    for (int k = 0; k < 8; k++) {
        World *world = make_world();
        add_ground(world, k == 7 ? 1 : 0.5f);
        if (k == 0) add_pyramid(world, 20, 1, 0.5f);
        if (k == 1) add_pyramid(world, 20, 1.125f, 0.5f);
        if (k == 2) add_pyramid(world, 12, 1.125f, 0);
        if (k == 3) add_wall(world, 12, 12, 0.5f);
        if (k == 4) add_wall(world, 9, 40, 0.5f);
        if (k == 5) add_wall(world, 8, 8, 1.5f);
        if (k == 6)
            for (int i = 0; i < 20; i++) add_box(world, i % 2 == 0 ? 1 : 1000, 0.5f, vec2(0, 0.5f + (float)i));
        if (k == 7) add_jam(world);
        assert_stands(world, 0.01, k < 3 ? 0.001 : 0.023);
    }
}

/* If sweeps might leave any error that is within the tolerance, every other step of this pyramid would take iterations,
   for ever. Two sweeps and what begins them are 5 units of work. */
TEST(steps_at_rest_need_no_iterations) {
    const SceneSetting rows = {.name = "rows", .value = 28};
    OWN(Scene) *scene = scene_read_with(SOURCE_DIR "/scenes/stability/pyramid_rows.yaml", &rows, 1, &error);
    assert_ok(scene != NULL, error);
    OWN(World) *world = world_of(scene);
    OWN(ContactSolver) solver = make_solver(&solver_interior, "");
    run(world, &solver, 600);
    int more = 0;
    for (int step = 0; step < 120; step++) {
        run(world, &solver, 1);
        more += interior_work_done(solver.state) > 5;
    }
    if (more > 0) fail_msg("%d of 120 steps", more);
}

/* In a step of 0.1 s what opens falls by 0.1 m. */
TEST(a_pyramid_stands_at_ten_steps_per_second) {
    OWN(World) *world = make_world();
    add_ground(world, 0.2f);
    for (int row = 0; row < 11; row++)
        for (int i = 0; i < 11 - row; i++)
            add_box(world, 10, 0.2f, vec2(-0.5625f * 11 + 0.5625f * (float)row + 1.125f * (float)i, 0.5f + (float)row));
    OWN(ContactSolver) solver = make_solver(&solver_interior, "");
    world_set_contacts(world, (ContactRules){.mend = true});
    for (int i = 0; i < 300; i++) assert_ok(world_step(world, solver.kind->solve, solver.state, 0.1f, &error), error);
    const double overlap = world_penetration(world);
    if (!(overlap < 0.001)) fail_msg("overlap %g m", overlap);
}

/* What moves in one island changes no bit in another: a box that slides by beside a pyramid, or flies there. */
TEST(a_stranger_changes_nothing) {
    World *worlds[3];
    for (int k = 0; k < 3; k++) {
        worlds[k] = make_world();
        add_ground(worlds[k], 0.5f);
        add_pyramid(worlds[k], 14, 1.125f, 0.5f);
        if (k == 1)
            add_body(worlds[k], &(BodyDef){.size = {1, 1}, .mass = 1, .position = {20, 0.5f}, .velocity = {1, 0}});
        if (k == 2)
            add_body(worlds[k], &(BodyDef){.size = {1, 1}, .mass = 1, .position = {20, 5}, .velocity = {0, 40}});
        OWN(ContactSolver) solver = make_solver(&solver_interior, "");
        run(worlds[k], &solver, 300);
    }
    for (int k = 1; k < 3; k++)
        for (int i = 0; i < world_body_count(worlds[0]); i++)
            assert_memory_equal(&world_bodies(worlds[0])[i].position, &world_bodies(worlds[k])[i].position,
                                sizeof(Vec2));
    const Body *stranger = &world_bodies(worlds[1])[world_body_count(worlds[0])];
    assert_near(stranger->position.x, 25, 1e-3); /* nothing holds it */
    for (int k = 0; k < 3; k++) world_destroy(worlds[k]);
}

RUN_TESTS(NULL, NULL)
