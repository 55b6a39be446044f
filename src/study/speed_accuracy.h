/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The speed-accuracy study: every method in every scene, on held-out launches.

   Two protocols. Frozen: all methods solve the same steps, sampled from engine runs. Closed: each method runs on its
   own trajectory. In both, the final velocities of a step are compared with the converged solution
   (reference/reference.h) of its contact problem. */
#pragma once
#include "common/progress.h"
#include "study/contenders.h"
#include "study/launch_choice.h"
#include "study/scene_study.h"

enum { STUDY_MAX_SCENES = 32 };

/* Progress per stage of the study. */
typedef struct StageProgress {
    const Progress *(*begin)(void *context, const char *what); /* called at the start of a stage */
    void *context;
} StageProgress;

typedef struct SpeedAccuracyScene SpeedAccuracyScene;

typedef struct SpeedAccuracyOptions {
    const char *const *scenes; /* paths of scene files */
    int scene_count;
    const char *methods; /* contenders_parse(); NULL: all */
    LaunchChoice launches;
    bool quick;         /* fewer launches, settings, steps and repetitions */
    const char *folder; /* created if missing */
    bool pages;         /* for draw() */
    /* Draws folder/chart.csv; scenes[scene_count]. The key is of what determines the result (study_key.h). */
    bool (*draw)(const struct SpeedAccuracyOptions *study, const SpeedAccuracyScene *scenes, uint64_t key,
                 Error *error);
} SpeedAccuracyOptions;

struct SpeedAccuracyScene {
    char name[CHART_NAME_SIZE];
    int contenders, launches;
    NameList without_network; /* methods left out, since neither their settings nor the scene name a network */
    double frozen_residual;   /* m/s: largest residual of the reference solves of frozen steps */
    int solves, unconverged;  /* reference solves in closed loop since the study was started or resumed; those
                                 with a residual above SOLVE_CONVERGED (rollout.h) */
};

/* Of the studies. */
const StudySize *speed_accuracy_size(bool quick);

/* Writes folder/chart.csv, fills scenes[scene_count] and draws. Finished rows are saved in folder/chart-KEY.part.csv: an
   interrupted study is resumed if options, files and program are the same. ERROR_INPUT for an invalid option, scene or
   launch, ERROR_INTERRUPTED if progress stops the study. */
bool speed_accuracy_run(const SpeedAccuracyOptions *options, const StageProgress *progress, SpeedAccuracyScene *scenes,
                        Error *error);
