/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Closed-loop comparison: a method and the engine run the same launches, each on its own trajectory. */
#pragma once
#include "study/frozen.h"

enum { CLOSED_LOOP_FRAMES = 600 };

#define CLOSED_LOOP_APART 0.1 /* m */

typedef struct ClosedLoop {
    double frames_until_apart; /* first frame in which a body is more than CLOSED_LOOP_APART from the engine's; median
                                  over launches; CLOSED_LOOP_FRAMES: never */
    double penetration_max;    /* m: the deepest contact of all launches */
    double momentum_error;     /* N s: momentum created per step (ContactSolution), mean */
    double energy_ratio;       /* largest mechanical energy / energy when the bomb was added; largest of all launches */
} ClosedLoop;

/* Runs launches[count] of a scene for CLOSED_LOOP_FRAMES. A run ends early if its state becomes NaN or infinite. */
bool closed_loop_run(const Method *method, const Scene *launches, int count, ClosedLoop *result, Error *error);

/* Microseconds per step of a method and of the engine, measured in turns on engine states: mean over states, median
   over repetitions. */
bool closed_loop_time(const Method *method, const SnapshotList *states, int repetitions, double *us_step,
                      double *us_step_engine, Error *error);
