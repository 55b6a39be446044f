/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Poses of a scene's launches, recorded for training. */
#pragma once
#include "common/progress.h"
#include "scene/launch.h"
#include "simulate/method.h"

typedef struct LaunchRuns {
    int count;        /* of launches */
    int frames;       /* of each: steps + 1 */
    int bodies;       /* with the bomb, the last */
    Launch *launches; /* [count] */
    BodyPose *poses;  /* [count, frames, bodies] NaN while the bomb does not exist */
} LaunchRuns;

/* Runs the launches [count] of a scene with a bomb by a method, in parallel; the same bits for any number of threads. False
   with error set if a run fails, the poses take more than 1 GiB, or progress requests a stop. Free it in any case. */
bool launch_runs_record(LaunchRuns *runs, const Scene *scene, const Method *method, const Launch *launches, int count,
                        const Progress *progress, Error *error);
void launch_runs_free(LaunchRuns *runs);

/* The poses[bodies] of a frame; frame 0 is the state before the first step. */
static inline const BodyPose *launch_runs_frame(const LaunchRuns *runs, int launch, int frame) {
    return runs->poses + ((size_t)launch * (size_t)runs->frames + (size_t)frame) * (size_t)runs->bodies;
}
