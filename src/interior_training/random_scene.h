/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random scenes in memory: training problems of interior-net come from their runs. Stacks, towers of mixed sizes and
   masses, small pyramids, walls, piles, gates (a beam on two stacks) and dominoes, each hit by a random bomb after it
   has settled: mass, size, point, direction, speed, rotation and spin are drawn. */
#pragma once
#include "scene/scene.h"

enum { RANDOM_SCENE_BODIES = 44 }; /* at most 40 that move, ground and walls */

typedef struct RandomScene {
    Scene scene; /* its bodies are those below: do not move the struct, and do not scene_destroy() it */
    BodyDef bodies[RANDOM_SCENE_BODIES];
} RandomScene;

/* The family is that of `number` modulo the count of families; everything else depends on seed and number. */
void random_scene_make(RandomScene *random, uint64_t seed, int number);
