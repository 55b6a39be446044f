/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The energy of a run, frame by frame: what other runs of the same scene are held against. */
#pragma once
#include "simulate/simulate.h"

#include <stddef.h>

/* Zero-initialise; freed by energy_log_free, and may be begun again. */
typedef struct EnergyLog {
    Vec2 gravity;
    int frames;     /* of the run */
    double *energy; /* [frames + 1] J: kinetic and potential, of all that moves */
    /* J: the larger of two. What has been lost: the most by which the energy was below where it stood before. What a body
       that joins brings along counts as there to be lost; what leaves with a body has not been lost. Where bodies overlap
       at the start, the energy that pushing them apart adds can be lost too. And what could fall: of all that moves at the
       start, and of what joins, m |g| times its height above the lowest that moves at the start. So a stack that stands
       has all its height to lose. */
    double to_lose;
    double standing; /* J: what could fall */
    double lowest;   /* m, against gravity: of what moves at the start; INFINITY: nothing has moved so far */
    double level;    /* J: energy there would be had none been lost */
    int body_count;  /* in the last frame logged */
    size_t capacity;
} EnergyLog;

void energy_log_free(EnergyLog *log);

/* Begins the log of a run of `frames` steps from these bodies. */
bool energy_log_begin(EnergyLog *log, Vec2 gravity, int frames, const Body *bodies, int count, Error *error);

/* Adds frame 1, 2, ... frames. Bodies may have joined at the end, or the last ones have left, but not both at once. */
void energy_log_step(EnergyLog *log, int frame, const Body *bodies, int count);

/* Makes the log of a scene's run by a method. ERROR_INPUT also where a body leaves the finite numbers. */
bool energy_log_run(EnergyLog *log, const Scene *scene, const Method *method, Error *error);
