/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fits momentum schedules to a scene: for each number of sweeps the factors that leave the smallest error, found by
   CMA-ES from those set by hand. Error: RMS velocity error (solution_error.h) against the reference, its mean over the
   frames of impact plus its mean over those after, of problems from the engine's runs (impact_problems.h). */
#pragma once
#include "common/error.h"
#include "common/parse.h"
#include "common/progress.h"
#include "network/momentum_schedule.h"
#include "scene/scene.h"

typedef struct MomentumFitOptions {
    FloatRange bomb_x; /* launches to fit to, m */
    int generations;   /* of CMA-ES, for each number of sweeps */
    uint64_t seed;
    /* Called with the error of plain sweeps, of factors set by hand and of those found; may be NULL. */
    void (*on_schedule)(void *context, int sweeps, double plain, double by_hand, double learned);
    void *context;
} MomentumFitOptions;

/* Schedules for 5, 10, 20 and 50 sweeps, `command` left empty; the same bits at any number of threads. When progress
   asks to stop after the recording, each is the best met by then. */
bool momentum_fit(MomentumSchedules *schedules, const Scene *scene, const MomentumFitOptions *options,
                  const Progress *progress, Error *error);
