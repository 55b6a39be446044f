/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Worlds whose next step the reference solves. */
#pragma once
#include "worlds.h"

#include "methods/reference.h"

static const double tight = REFERENCE_TOLERANCE;

/* Solves the contact problem that the world's next step meets. The engine makes the step. */
static inline const ContactProblem *solve_next(World *world, Reference *reference) {
    Error error = {0};
    assert_ok(reference_solve(reference, next_problem(world), NULL, &error), error);
    if (!(reference->residual <= tight))
        fail_msg("residual %g after %d factorizations", reference->residual, reference->factorizations);
    return world_problem(world);
}

/* A leaning heap: five boxes hit by a heavy one from the side, as they stand after that many steps. */
static inline World *make_heap(int steps) {
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
    run_engine(world, "", steps);
    return world;
}
