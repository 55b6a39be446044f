/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The launch that was worst for a method in a chart: what a page shows of a point. */
#pragma once
#include "common/progress.h"
#include "study/scene_study.h"

typedef struct WorstLaunch {
    int launch;        /* of the study's; -1: no step of the phase was scored */
    double mean;       /* m/s: its mean error in the phase, chart.csv's error_worst */
    double error;      /* m/s: of the scored step of the phase with the largest error, */
    int frame, body;   /* which leads to this frame; its body with the largest error, or -1 */
    int touch, frames; /* the first step in which the bomb touches; frames of the run: fewer if its state became NaN */
} WorstLaunch;

/* Runs all launches of the study in closed loop once more, in parallel, and fills the impact and after phases of
   worst[PHASES]. */
bool worst_launch_find(const SceneStudy *study, const Method *method, WorstLaunch worst[PHASES],
                       const Progress *progress, Error *error);
