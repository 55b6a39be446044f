/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sensitivity of a run to its initial state: the scene is run twice by one method, once unchanged and once with one
   body shifted by a micrometre. */
#pragma once
#include "common/progress.h"
#include "trajectory/trajectory.h"

#define CHAOS_SHIFT 1e-6f /* m, along x; more if float32 cannot resolve it there */

typedef struct Chaos {
    int body;     /* the one shifted: the bomb, or without one the last that can move */
    double shift; /* m, as it came out in float32 */
    int other;    /* first frame in which the scene, run again as it is, is not the run given; -1: it is the same */
    int frames;
    double *distance; /* [frames] m, the largest of all bodies; NAN once the shifted run is NaN or infinite */
} Chaos;

/* Which body to shift, for runs that diverge in this frame at body `parted` (-1, -1: nowhere): the bomb, or without one
   the last body that can move. A difference cannot grow without contact: if the bomb has not touched anything by that
   frame, it is the body that diverges. -1: no body can move. */
int chaos_body(const Trajectory *run, int parted, int frame);

/* Reads the scene at `path`, which must be that of the run (the hash is checked), and runs its first `frames` frames
   with the run's method; `body` must be able to move. ERROR_INPUT for another scene, or if the method cannot be
   created. */
bool chaos_run(Chaos *chaos, const char *path, const Trajectory *run, int body, int frames, const Progress *progress,
               Error *error);
void chaos_free(Chaos *chaos);
