/* SPDX-License-Identifier: GPL-3.0-or-later */
/* twinbox train --kind momentum-schedule: options as text. */
#pragma once
#include "common/error.h"

typedef struct TrainMomentum {
    const char *scene, *output, *iterations, *seed, *bomb_x;
} TrainMomentum;

bool train_momentum(const TrainMomentum *options, Error *error);
