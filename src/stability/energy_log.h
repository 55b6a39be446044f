/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy of a run per frame: the reference for judging other runs of the same scene. */
#pragma once
#include "simulate/simulate.h"

#include <stddef.h>

/* Zero-initialise; free with energy_log_free(); may be begun again. */
typedef struct EnergyLog {
    Vec2 gravity;
    int frames;     /* of the run */
    double *energy; /* [frames + 1] J: mechanical energy of all dynamic bodies */
    /* J: energy available to be lost, the larger of two.
       (a) The energy lost so far: the largest drop below the highest level before. Energy that an added body brings, or
       that pushing overlapping bodies apart adds, raises the level; energy of a removed body lowers it.
       (b) The potential energy of all dynamic bodies at the start, and of added ones: m |g| times the height above the
       lowest dynamic body at the start. So a standing stack has all its height to lose. */
    double available;
    double potential; /* J: (b) */
    double lowest;    /* m: lowest height of a dynamic body at the start; INFINITY: no dynamic body so far */
    double level;     /* J: energy if none had been lost */
    int body_count;   /* in the last frame */
    size_t capacity;
} EnergyLog;

void energy_log_free(EnergyLog *log);

/* Begins the log of a run of `frames` steps with the bodies at the start. */
bool energy_log_begin(EnergyLog *log, Vec2 gravity, int frames, const Body *bodies, int count, Error *error);

/* Adds frame 1, 2, ... frames. Bodies may be appended, or the last ones removed, but not both in one step. */
void energy_log_step(EnergyLog *log, int frame, const Body *bodies, int count);

/* Runs a scene with a method and logs it. ERROR_INPUT also if the state becomes NaN or infinite. */
bool energy_log_run(EnergyLog *log, const Scene *scene, const Method *method, Error *error);
