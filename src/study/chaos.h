/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How fast a run parts from itself: a scene run twice by one method, once as it is and once with one body a millionth of
   a metre aside. */
#pragma once
#include "common/progress.h"
#include "trajectory/trajectory.h"

#define CHAOS_SHIFT 1e-6f /* m, in x; at least what float32 can tell apart at that place */

typedef struct Chaos {
    int body;     /* the one shifted: the bomb, or without one the last that can move */
    double shift; /* m, as it came out in float32 */
    int other;    /* first frame in which the scene, run again as it is, is not the run given; -1: it is the same */
    int frames;
    double
        *distance; /* [frames] m, the largest of all bodies; NAN from where the shifted run left the finite numbers */
} Chaos;

/* Which body to shift, for runs that part in this frame with body `parted` (-1, -1: nowhere): the bomb; without one the
   last that can move. What touches nothing cannot grow: where the bomb has not hit by then it is the body that parts. -1:
   nothing can move. */
int chaos_body(const Trajectory *run, int parted, int frame);

/* Reads the scene at `path`, which must be that of the run (its hash is checked), and runs it for the first `frames` frames
   by the run's method; `body` is one that can move. ERROR_INPUT
   where it is another scene or its method cannot be had. */
bool chaos_run(Chaos *chaos, const char *path, const Trajectory *run, int body, int frames, const Progress *progress,
               Error *error);
void chaos_free(Chaos *chaos);
