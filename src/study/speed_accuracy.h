/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The speed-accuracy study: every method in every scene, on held-out launches.

   Two protocols. Frozen: all methods solve the same steps, sampled from engine runs. Closed: each method runs on its
   own trajectory. In both, the final velocities of a step are compared with the converged solution
   (reference/reference.h) of its contact problem. */
#pragma once
#include "study/chart_assembly.h"

enum { STUDY_MAX_SCENES = 32 };

typedef struct SpeedAccuracyScene SpeedAccuracyScene;

typedef struct SpeedAccuracyOptions {
    const char *const *scenes; /* paths of scene files */
    int scene_count;
    const char *methods; /* contenders_parse(); NULL: all */
    LaunchChoice launches;
    bool quick;           /* fewer launches, settings, steps and repetitions */
    const char *folder;   /* created if missing */
    bool pages;           /* for draw() */
    const PiecesRun *run; /* whole, a shard, or a merge */
    /* Draws folder/chart.csv; scenes[scene_count]. The key is of what determines the result (study_key.h). */
    bool (*draw)(const struct SpeedAccuracyOptions *study, const SpeedAccuracyScene *scenes, uint64_t key,
                 Error *error);
} SpeedAccuracyOptions;

struct SpeedAccuracyScene {
    char name[CHART_NAME_SIZE];
    int contenders, launches;
    NameList without_network; /* methods left out, since neither their settings nor the scene name a network */
    SceneSolves solves;
    bool timed; /* not if a merge leaves out its times */
};

/* Of the studies. */
const StudySize *speed_accuracy_size(bool quick);

/* Does the pieces of the study, then writes folder/chart.csv, fills scenes[scene_count] and draws; a shard does its pieces
   only. An interrupted study continues if options, files and program are the same. ERROR_INPUT for an invalid option,
   scene or launch, ERROR_INTERRUPTED if progress stops the study. *pieces tells what was done; it has no plan any more. */
bool speed_accuracy_run(const SpeedAccuracyOptions *options, Pieces *pieces, const Progress *progress,
                        SpeedAccuracyScene *scenes, Error *error);
