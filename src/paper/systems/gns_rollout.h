/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run of gns beside the run of the method that made its training data. */
#pragma once
#include "scene/launch.h"

enum { GNS_TIMES = 9 };
extern const double gns_times[GNS_TIMES]; /* s after the bomb's launch, rising */

typedef struct GnsRollout {
    int boxes;               /* that move, with the bomb */
    double error[GNS_TIMES]; /* m: mean distance between the boxes of both; at times after the scene's end those of its
                                       last frame. A run that breaks off keeps its last places */
    double shape[GNS_TIMES]; /* m: gns_shape_distance */
    double moved, moved_teacher; /* boxes that are more than 0.5 m off their place of the launch, at the last time */
    double seconds_a_step;       /* of gns's own work, mean */
} GnsRollout;

/* launched: a scene with its launch. network: a file; settings: further ones of gns ("rigid=off", ""). */
bool gns_rollout_run(GnsRollout *rollout, const Scene *launched, const char *network, const char *settings,
                     Error *error);
