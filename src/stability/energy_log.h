/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy of a run per frame: the reference for judging other runs of the same scene. */
#pragma once
#include "simulate/simulate.h"
#include "stability/energy_balance.h"

#include <stddef.h>

/* Zero-initialise; free with energy_log_free(); may be begun again. */
typedef struct EnergyLog {
    int frames;            /* of the run */
    double *energy;        /* [frames + 1] J: as in EnergyBalance */
    EnergyBalance balance; /* after the last frame */
    size_t capacity;
} EnergyLog;

void energy_log_free(EnergyLog *log);

/* Begins the log of a run of `frames` steps with the bodies at the start. */
bool energy_log_begin(EnergyLog *log, Vec2 gravity, int frames, const Body *bodies, int count, Error *error);

/* Adds frame 1, 2, ... frames. Bodies may be appended, or the last ones removed, but not both in one step. */
void energy_log_step(EnergyLog *log, int frame, const Body *bodies, int count);

/* Runs a scene with a method and logs it. ERROR_INPUT also if the state becomes NaN or infinite. */
bool energy_log_run(EnergyLog *log, const Scene *scene, const Method *method, Error *error);
