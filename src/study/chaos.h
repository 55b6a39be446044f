/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sensitivity to the initial state: runs a scene twice with one method, the second time with one body shifted by a
   micrometre, and measures how fast the runs diverge. */
#pragma once
#include "common/progress.h"
#include "trajectory/trajectory.h"

#define CHAOS_SHIFT 1e-6f /* m, in x; at least one ulp of the position */

typedef struct Chaos {
    int body;          /* the shifted body */
    double shift;      /* m, as represented in float32 */
    int rerun_differs; /* first frame in which the unshifted run differs from the given run; -1: none */
    int frames;
    double *distance; /* [frames] m, the largest of all bodies; NaN from where the shifted run is NaN or infinite */
} Chaos;

/* The body to shift, given that two runs diverge in this frame at body `diverged` (-1, -1: nowhere): the bomb or,
   without a bomb, the last dynamic body. If the bomb has touched nothing by that frame its shift cannot grow, so
   `diverged` is returned. -1: no dynamic body. */
int chaos_body(const Trajectory *run, int diverged, int frame);

/* Reads the scene at `path`, checks its hash against the run's, and runs `frames` frames with the run's method. `body`
   must be dynamic. ERROR_INPUT for another scene or an unavailable method. */
bool chaos_run(Chaos *chaos, const char *path, const Trajectory *run, int body, int frames, const Progress *progress,
               Error *error);
void chaos_free(Chaos *chaos);
