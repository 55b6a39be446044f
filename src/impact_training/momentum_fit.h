/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fits momentum schedules to a scene. For each number of sweeps, CMA-ES minimises the error over the factors, starting
   from the hand-tuned ones. Error: RMS velocity error against the reference (solution_error.h) on problems of engine
   runs (impact_problems.h); mean over impact frames plus mean over frames after. */
#pragma once
#include "common/error.h"
#include "common/parse.h"
#include "common/progress.h"
#include "network/momentum_schedule.h"
#include "scene/scene.h"

typedef struct MomentumFitOptions {
    FloatRange bomb_x; /* launches, m */
    int generations;   /* of CMA-ES, for each number of sweeps */
    uint64_t seed;
    /* Called with the error without momentum, with hand-tuned factors and with learned factors; may be NULL. */
    void (*on_schedule)(void *context, int sweeps, double without, double hand_tuned, double learned);
    void *context;
} MomentumFitOptions;

/* Schedules for 5, 10, 20 and 50 sweeps; `command` is left empty. If progress stops the fit after the recording, each
   schedule is the best found so far. Same bits for any number of threads. */
bool momentum_fit(MomentumSchedules *schedules, const Scene *scene, const MomentumFitOptions *options,
                  const Progress *progress, Error *error);
