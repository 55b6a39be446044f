/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox's engine with the defaults of a scene file. */
#include "report.h"
#include "rival.h"

#include "engine/engine.h"
#include "methods/methods.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct Engine {
    World *world;
    ContactSolver solver;
} Engine;

static void check(bool ok, const Error *error) {
    if (!ok) give_up(error->message);
}

static void *create(void) {
    Error error = {0};
    const WorldDef def = {.gravity = {0, -10}, .warm_starting = true, .position_correction = true};
    const Settings settings = {0};
    Engine *engine = malloc(sizeof *engine);
    if (engine == NULL) abort();
    engine->world = world_create(&def, &error);
    engine->solver = (ContactSolver){&solver_engine, solver_engine.create(&settings, &error)};
    check(engine->world != NULL && engine->solver.state != NULL, &error);
    return engine;
}

static void add(void *world, const RivalBox *box) {
    Error error = {0};
    const BodyDef def = {.size = {box->width, box->height},
                         .fixed = box->fixed,
                         .mass = box->mass,
                         .friction = box->friction,
                         .position = {box->x, box->y},
                         .velocity = {box->vx, box->vy}};
    check(world_add_body(((Engine *)world)->world, &def, &error), &error);
}

static void step(void *world) {
    Error error = {0};
    Engine *engine = world;
    check(world_step(engine->world, engine->solver.kind->solve, engine->solver.state, 1.0f / 60.0f, &error), &error);
}

static void destroy(void *world) {
    Engine *engine = world;
    engine->solver.kind->destroy(engine->solver.state);
    world_destroy(engine->world);
    free(engine);
}

const Rival rival_twinbox = {"twinbox", create, add, step, destroy};
