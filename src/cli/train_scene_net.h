/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox train --kind scene-net: its own part of the command. */
#pragma once
#include "common/error.h"

#include <stdbool.h>

/* As given; texts are numbers. */
typedef struct TrainSceneNet {
    const char *scene, *output, *iterations, *seed, *launches, *rounds, *width, *sweeps, *momentum;
    bool smallest;      /* the smallest network that reaches .. */
    const char *within; /* .. this error, m/s */
} TrainSceneNet;

bool train_scene_net(const TrainSceneNet *options, Error *error);
