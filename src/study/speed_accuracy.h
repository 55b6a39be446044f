/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Speed against accuracy: every method in every scene, on held-out launches.

   Two protocols. Frozen: all methods take the same steps, sampled from the engine's runs. Closed: each method runs on
   its own trajectory. In both, a step is scored by its end velocities against the converged solution
   (reference/reference.h) of its contact problem. */
#pragma once
#include "common/progress.h"
#include "study/contenders.h"

enum { STUDY_MAX_SCENES = 16 };

/* A study has stages, each with its own progress. */
typedef struct StageProgress {
    const Progress *(*begin)(void *context, const char *what); /* called at the start of a stage */
    void *context;
} StageProgress;

typedef struct SpeedAccuracyOptions {
    const char *const *scenes; /* paths of scene files */
    int scene_count;
    const char *methods;  /* contenders_parse(); NULL: all */
    const char *launches; /* path of a table of launches (scene/launch.h); NULL: launches_for_scoring() */
    bool quick;           /* fewer launches, settings, steps and repetitions */
    const char *folder;   /* created if missing */
} SpeedAccuracyOptions;

typedef struct SpeedAccuracyScene {
    char name[CHART_NAME_SIZE];
    int contenders, launches;
    NameList without_network; /* methods left out, since neither their settings nor the scene name a network */
    double frozen_residual;   /* m/s: the largest of the reference solves of frozen steps */
    int solves, unconverged;  /* in closed loop, by this run of the program: reference solves, and those with a residual
                                above SOLVE_CONVERGED (rollout.h) */
} SpeedAccuracyScene;

/* Writes folder/chart.csv, and fills scenes[scene_count]. Finished rows are kept beside it in chart-KEY.part.csv, so
   that the same study by the same program resumes after an interruption. ERROR_INPUT for a bad option, scene or launch,
   or if progress requests a stop. */
bool speed_accuracy_run(const SpeedAccuracyOptions *options, const StageProgress *progress, SpeedAccuracyScene *scenes,
                        Error *error);
