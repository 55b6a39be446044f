/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Worlds in which boxes almost touch, or are wedged: they stand, slide on, and gain no energy. */
#include "worlds.h"

static const ContactSolverKind *const kinds[] = {&solver_interior, &solver_reference, &solver_momentum, &solver_nncg,
                                                 &solver_admm};
enum { KINDS = sizeof kinds / sizeof *kinds };

static float fastest(const World *world) {
    float most = 0;
    for (int i = 0; i < world_body_count(world); i++)
        most = fmaxf(most, fabsf(world_bodies(world)[i].velocity.x) + fabsf(world_bodies(world)[i].velocity.y));
    return most;
}

/* Layers at i * h have gaps of float rounding, through which all but the lowest fell in the first step. */
TEST(a_stack_of_any_height_stands_at_once) {
    static const float heights[] = {0.3f, 0.6f, 0.9f, 1.1f};
    for (int m = 0; m < 2; m++)
        for (int h = 0; h < 4; h++) {
            OWN(World) *world = make_world();
            OWN(ContactSolver) solver = make_solver(kinds[m], "");
            add_ground(world, 0.5f);
            for (int i = 0; i < 30; i++)
                add_body(world, &(BodyDef){.size = {1, heights[h]},
                                           .mass = 1,
                                           .friction = 0.5f,
                                           .position = {0, heights[h] * (0.5f + (float)i)}});
            run(world, &solver, 10);
            if (fastest(world) > 1e-3f)
                fail_msg("%s, boxes of %g m: %g m/s", kinds[m]->description.name, (double)heights[h],
                         (double)fastest(world));
        }
}

/* Without friction it keeps its speed, whatever the sinking of the boxes that it slides over. */
TEST(a_box_slides_over_seams_of_boxes) {
    for (int m = 0; m < KINDS; m++)
        for (float speed = 2; speed < 9; speed += 3) {
            OWN(World) *world = make_world();
            OWN(ContactSolver) solver = make_solver(kinds[m], kinds[m] == &solver_admm ? "k=20" : "");
            add_ground(world, 0.5f);
            for (int i = 0; i < 8; i++)
                add_body(world, &(BodyDef){.size = {1, 1}, .mass = 100, .position = {(float)i, 0.5f}});
            add_body(world, &(BodyDef){.size = {1, 1}, .mass = 1, .position = {0, 1.5f}, .velocity = {speed, 0}});
            run(world, &solver, (int)(6 / (speed * world_dt)));
            const float left = world_bodies(world)[9].velocity.x;
            if (left < 0.99f * speed)
                fail_msg("%s: %g m/s of %g", kinds[m]->description.name, (double)left, (double)speed);
        }
}

/* Nine boxes between fixed walls, 3% too wide for the gap: no impulses push all of them out, but a row that buckles. */
TEST(a_jam_gains_no_energy) {
    static const float masses[] = {0.19f, 0.73f, 0.7f, 1.2f, 1.2f, 0.31f, 1.1f, 0.69f, 0.22f};
    for (int m = 0; m < KINDS; m++) {
        OWN(World) *world = make_world();
        OWN(ContactSolver) solver = make_solver(kinds[m], "");
        for (int i = -1; i <= 1; i += 2)
            add_body(world,
                     &(BodyDef){.size = {2, 4}, .fixed = true, .friction = 2, .position = {2.83f * (float)i, 0}});
        for (int i = 0; i < 9; i++)
            add_body(world, &(BodyDef){.size = {0.42f, 0.97f},
                                       .mass = masses[i],
                                       .friction = 2,
                                       .position = {0.407f * (float)(i - 4), 0}});
        const double before = world_energy(world, vec2(0, -10));
        for (int step = 0; step < 100; step++) {
            run(world, &solver, 1);
            const double gained = world_energy(world, vec2(0, -10)) - before;
            if (gained > 1) fail_msg("%s, step %d: %g J", kinds[m]->description.name, step, gained);
        }
    }
}

RUN_TESTS(NULL, NULL)
