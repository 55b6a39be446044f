/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The speed-accuracy study: every method in every scene. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "runs/pieces.h"
#include "studies/chart_plot.h"
#include "studies/chart_table.h"
#include "studies/scene_study.h"

#include <stdbool.h>
#include <stdint.h>

/* What the pieces of a scene say about its reference solves. */
typedef struct SceneSolves {
    int64_t frozen, frozen_unconverged; /* frozen steps; those left out of them (converged_step_found()) */
    int64_t closed, closed_unconverged; /* the same in closed loop, of all methods together */
    int64_t runs_unconverged;           /* steps of the converged runs that did not converge */
} SceneSolves;

/* The speed-accuracy study: every method in every scene, on held-out launches.

   Two protocols. Frozen: all methods solve the same steps, sampled from engine runs. Closed: each method runs on its
   own trajectory. In both, the final velocities of a step are compared with the converged solution
   (methods/reference.h) of its contact problem. */

enum { STUDY_MAX_SCENES = 32 };

typedef struct SpeedAccuracyScene SpeedAccuracyScene;

typedef struct SpeedAccuracyOptions {
    const char *const *scenes; /* paths of scene files */
    int scene_count;
    const char *methods; /* contenders_parse(); NULL: all */
    LaunchChoice launches;
    bool quick;         /* fewer launches, settings, steps and repetitions */
    const char *folder; /* created if missing */
    ChartLook look;     /* for draw() */
    Shard shard;
    /* Is told of each scene before the work; NULL: nothing is. */
    void (*begin)(const SpeedAccuracyScene *scene);
    /* Draws folder/chart.csv; scenes[scene_count]. */
    bool (*draw)(const struct SpeedAccuracyOptions *study, const SpeedAccuracyScene *scenes, Error *error);
} SpeedAccuracyOptions;

struct SpeedAccuracyScene {
    char name[CHART_NAME_SIZE];
    int contenders, launches, striking; /* striking: launches that strike a box */
    NameList without_network; /* methods left out, since neither their settings nor the scene name a network */
    SceneSolves solves;
};

/* Does the pieces of the study, then writes folder/chart.csv, fills scenes[scene_count] and draws; a shard does its
   pieces only. An interrupted study continues if options, files and program are the same. ERROR_INPUT for an invalid
   option, scene or launch, ERROR_INTERRUPTED if progress stops the study. *pieces tells what was done; it has no plan
   any more. */
bool speed_accuracy_run(const SpeedAccuracyOptions *options, Pieces *pieces, const Progress *progress,
                        SpeedAccuracyScene *scenes, Error *error);
