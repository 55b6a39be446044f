/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes that a seed makes: structures of 2 to 80 bodies, with sides of 0.01 to 20 m, masses spread by up to a million
   and friction of 0 to 2; every other one is struck. The same seed gives the same scene on every machine. */
#pragma once
#include "base/base.h"
#include "base/random.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { STRUCTURES = 1000, STRUCTURE_BODIES = 80, STRUCTURE_FRAMES = 120 };

typedef struct Structure {
    uint64_t random;
    Scene *scene;
    double unit;     /* m: a side of its largest boxes, or their length */
    double spread;   /* masses are 1000 kg over 1 to this */
    double friction; /* of all bodies */
    int wanted;      /* bodies, with the ground */
} Structure;

static inline double structure_between(Structure *made, double from, double to) {
    return from + (to - from) * random_unit(&made->random);
}

static inline double structure_power(Structure *made, double from, double to) {
    return pow(10, structure_between(made, log10(from), log10(to)));
}

static inline BodyDef *structure_body(Structure *made, double x, double y, double width, double height) {
    BodyDef *body = &made->scene->bodies[made->scene->body_count++];
    *body = (BodyDef){.size = {(float)width, (float)height},
                      .mass = (float)(1000 / structure_power(made, 1, made->spread)),
                      .friction = (float)made->friction,
                      .position = {(float)x, (float)y}};
    return body;
}

static inline bool structure_full(const Structure *made) { return made->scene->body_count >= made->wanted; }

/* Boxes above each other, a little askew. */
static inline void structure_stack(Structure *made) {
    const double u = made->unit;
    for (int i = 0; !structure_full(made); i++)
        structure_body(made, 0.1 * u * structure_between(made, -1, 1), (i + 0.5) * u, u, u);
}

/* Bricks in bond. */
static inline void structure_wall(Structure *made) {
    const double u = made->unit;
    const int width = 2 + random_below(&made->random, 6);
    for (int row = 0; !structure_full(made); row++)
        for (int i = 0; i < width && !structure_full(made); i++)
            structure_body(made, (i + 0.5 * (row % 2)) * u, (row + 0.5) * 0.5 * u, u, 0.5 * u);
}

static inline void structure_pyramid(Structure *made) {
    const double u = made->unit;
    int rows = 1;
    while ((rows + 1) * (rows + 2) / 2 < made->wanted) rows++;
    for (int row = 0; row < rows; row++)
        for (int i = 0; i < rows - row && !structure_full(made); i++)
            structure_body(made, (i + 0.5 * row) * u, (row + 0.5) * u, u, u);
}

/* Floors of two pillars and a plank. */
static inline void structure_tower(Structure *made) {
    const double u = made->unit, pillar = 0.4 * u, plank = 0.1 * u;
    for (int floor = 0; !structure_full(made); floor++) {
        const double y = floor * (pillar + plank);
        for (int side = -1; side <= 1 && !structure_full(made); side += 2)
            structure_body(made, 0.4 * side * u, y + 0.5 * pillar, 0.15 * u, pillar);
        if (!structure_full(made)) structure_body(made, 0, y + pillar + 0.5 * plank, u, plank);
    }
}

/* A row of pillars with planks from one to the next and loads on these. */
static inline void structure_bridge(Structure *made) {
    const double u = made->unit;
    const int spans = made->wanted > 4 ? (made->wanted - 2) / 3 : 1;
    for (int i = 0; i <= spans && !structure_full(made); i++) structure_body(made, i * u, 0.25 * u, 0.15 * u, 0.5 * u);
    for (int i = 0; i < spans && !structure_full(made); i++)
        structure_body(made, (i + 0.5) * u, 0.525 * u, u, 0.05 * u);
    for (int i = 0; !structure_full(made); i++)
        structure_body(made, (i % spans + structure_between(made, 0.2, 0.8)) * u, (0.65 + 0.2 * (i / spans)) * u,
                       0.2 * u, 0.2 * u);
}

/* Boxes of any size and angle that fall onto the ground. */
static inline void structure_heap(Structure *made) {
    const double u = made->unit;
    const int width = 1 + random_below(&made->random, 5);
    for (int i = 0; !structure_full(made); i++) {
        BodyDef *body = structure_body(made, (i % width) * 1.5 * u, (1 + i / width) * 1.5 * u,
                                       u * structure_between(made, 0.3, 1), u * structure_between(made, 0.3, 1));
        body->angle = (float)structure_between(made, -1.5, 1.5);
    }
}

typedef struct StructureKind {
    const char *name;
    void (*make)(Structure *made);
} StructureKind;

static const StructureKind structure_kinds[] = {{"stack", structure_stack},     {"wall", structure_wall},
                                                {"pyramid", structure_pyramid}, {"tower", structure_tower},
                                                {"bridge", structure_bridge},   {"heap", structure_heap}};

/* From the left, at any height, within 15 steps. */
static inline void structure_strike(Structure *made) {
    Scene *scene = made->scene;
    double left = 0, top = 0;
    for (int i = 1; i < scene->body_count; i++) {
        const BodyDef *body = &scene->bodies[i];
        const double reach = 0.5 * (double)(body->size.x + body->size.y);
        if ((double)body->position.x - reach < left) left = (double)body->position.x - reach;
        if ((double)body->position.y > top) top = (double)body->position.y;
    }
    const double side = made->unit * structure_between(made, 0.2, 1), speed = structure_power(made, 1, 100);
    scene->bomb = (SceneBomb){.present = true,
                              .size = {(float)side, (float)side},
                              .mass.value = (float)(1000 / structure_power(made, 1, made->spread)),
                              .friction = (float)made->friction,
                              .x.value = (float)(left - side - speed / 6),
                              .y = (float)(0.8 * side + structure_between(made, 0, 1) * top),
                              .velocity = {(float)speed, 0},
                              .impact_frames = SCENE_IMPACT_FRAMES};
}

/* Ends the program if memory is short; scene_destroy() frees it. */
static inline Scene *random_structure(int seed) {
    const int kinds = sizeof structure_kinds / sizeof *structure_kinds;
    Structure made = {.random = (uint64_t)seed, .scene = calloc(1, sizeof *made.scene)};
    Scene *scene = made.scene;
    if (scene == NULL || (scene->bodies = calloc(STRUCTURE_BODIES, sizeof *scene->bodies)) == NULL) abort();
    const StructureKind *kind = &structure_kinds[random_below(&made.random, kinds)];
    made.unit = structure_power(&made, 0.1, 20);
    made.spread = structure_power(&made, 1, 1e6);
    made.friction = random_below(&made.random, 8) == 0 ? 0 : structure_between(&made, 0, 2);
    const bool struck = seed % 2 == 1;
    made.wanted = (int)structure_power(&made, 2, STRUCTURE_BODIES + 0.999) - struck;
    if (made.wanted < 2) made.wanted = 2;
    snprintf(scene->name, sizeof scene->name, "%s %d", kind->name, seed);
    scene->gravity = vec2(0, -10);
    scene->dt = 1.0f / 60.0f;
    scene->iterations = 10;
    scene->frames = STRUCTURE_FRAMES;
    scene->warm_starting = scene->accumulate_impulses = scene->position_correction = true;
    scene->bodies[scene->body_count++] = (BodyDef){.size = {(float)(500 * made.unit), (float)(20 * made.unit)},
                                                   .fixed = true,
                                                   .friction = (float)made.friction,
                                                   .position = {0, (float)(-10 * made.unit)}};
    kind->make(&made);
    if (struck) structure_strike(&made);
    return scene;
}
