/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A method and the engine in closed loop, side by side. */
#pragma once
#include "study/frozen.h"

enum { CLOSED_LOOP_FRAMES = 600 };

#define CLOSED_LOOP_APART 0.1 /* m */

typedef struct ClosedLoop {
    double frames_until_apart; /* the first in which a body is farther than CLOSED_LOOP_APART from the engine's; median
                                  over the launches; CLOSED_LOOP_FRAMES: never */
    double penetration_max;    /* m: the deepest contact of all launches */
    double momentum_error;     /* N s made from nothing per step (ContactSolution), mean */
    double energy_ratio;       /* largest mechanical energy divided by that after the bomb appeared; largest */
} ClosedLoop;

/* Runs launches[count] of a scene for CLOSED_LOOP_FRAMES. A run whose state becomes NaN or infinite ends there. */
bool closed_loop_run(const Method *method, const Scene *launches, int count, ClosedLoop *result, Error *error);

/* Microseconds per step of the method and of the engine, in turns, from the engine's states: mean over the states,
   median over the repetitions. */
bool closed_loop_time(const Method *method, const SnapshotList *states, int repetitions, double *us_step,
                      double *us_step_engine, Error *error);
