/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Speed against accuracy: every method in every scene, on launches that nothing was trained on.

   Two protocols. Frozen: all methods take the same steps, sampled from the engine's runs. Closed: each runs on its own
   trajectory. Either way a step is scored by its end velocities against the converged solution (reference/reference.h) of
   the contact problem at its start. */
#pragma once
#include "common/progress.h"
#include "study/contenders.h"

enum { STUDY_MAX_SCENES = 16, STUDY_PATH_SIZE = 4096 };

/* A study goes through stages; each has a progress of its own. */
typedef struct StageProgress {
    const Progress *(*begin)(void *context, const char *what); /* called when a stage begins */
    void *context;
} StageProgress;

typedef struct SpeedAccuracyOptions {
    const char *const *scenes; /* paths of scene files */
    int scene_count;
    const char *methods;  /* contenders_parse(); NULL: all */
    const char *launches; /* path of a table of launches (scene/launch.h); NULL: launches_for_scoring() */
    bool quick;           /* fewer launches, settings, steps and repetitions */
    const char *folder;   /* made where missing */
} SpeedAccuracyOptions;

typedef struct SpeedAccuracyScene {
    char name[CHART_NAME_SIZE];
    int contenders, launches;
    ContenderNames without_network; /* methods left out, since neither their settings nor the scene name a network */
    double frozen_residual;         /* m/s: the largest of the reference solves of frozen steps */
    int solves, unconverged; /* in closed loop, by this run of the program: reference solves, those that left more than
                                SOLVE_CONVERGED (rollout.h) */
} SpeedAccuracyScene;

/* Writes folder/chart.csv, and fills scenes[scene_count]. What is done is kept beside it in chart-KEY.part.csv, so that the
   same study, by the same program, goes on where it was cut off. ERROR_INPUT for a bad option, scene or launch, or
   where progress asks to stop. */
bool speed_accuracy_run(const SpeedAccuracyOptions *options, const StageProgress *progress, SpeedAccuracyScene *scenes,
                        Error *error);
