/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scores of the methods on the launches of a scene, and the rows of chart.csv that are made of them. The scores
   of one launch are stored as bytes of this machine: the number of methods, what holds for all of them (LaunchSteps),
   where each method's part ends, then the parts; so those of one method are found at once. */
#pragma once
#include "base/base.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"
#include "studies/contenders.h"
#include "studies/rollout.h"
#include "studies/timing.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* A method on one launch. Zero-initialise. */
typedef struct LaunchScores {
    StepScores steps[PROTOCOLS][PHASES];
    RunMeasures measures;
    int unconverged; /* steps in closed loop, as in Rollout */
} LaunchScores;

void launch_scores_free(LaunchScores *scores);

/* What a launch says about its steps, whatever the methods. */
typedef struct LaunchSteps {
    int64_t unconverged;     /* frozen steps, as in SnapshotList */
    int64_t run_unconverged; /* as in RunLog, of the converged run */
    /* of the frozen steps, and in closed loop of the steps of the converged run */
    FloorSum floors[PROTOCOLS][PHASES];
} LaunchSteps;

/* Writes those of all methods, scores[count]. */
void launch_scores_write(FILE *results, const LaunchScores *scores, int count, const LaunchSteps *steps);

/* What is stored of a launch. */
typedef struct StoredScores {
    const char *path; /* for messages */
    const char *bytes;
    size_t size;
    int count; /* methods */
    LaunchSteps steps;
} StoredScores;

/* Looks at stored results with so many methods. ERROR_INPUT if they are damaged. The bytes must outlive *stored. */
bool stored_scores_open(StoredScores *stored, const char *path, const char *bytes, size_t size, int count,
                        Error *error);

typedef struct PhaseScores {
    int count;
    double *error, *share; /* [count], as in StepScores */
    CriteriaSum criteria;
    size_t error_capacity, share_capacity;
} PhaseScores;

/* A method on several launches. Zero-initialise. */
typedef struct MethodScores {
    PhaseScores steps[PROTOCOLS][PHASES];
    double worst[PHASES]; /* m/s: largest mean error of a launch in closed loop; NaN without a scored step */
    int worst_launch[PHASES];
    RunMeasures *measures; /* [launches] */
    int launches;
    int64_t unconverged; /* steps in closed loop, as in Rollout */
    size_t measure_capacity;
} MethodScores;

/* Adds a launch. ERROR_INPUT if its part is damaged. */
bool method_scores_add(MethodScores *scores, const StoredScores *stored, int method, Error *error);
void method_scores_free(MethodScores *scores);

/* Rows of chart.csv from the results of a scene's launches. */

/* A row with names but without results. The names must outlive the row. */
ChartRow scene_row(const char *scene, int launches, const Contender *contender, int protocol, int phase);

/* Sets mean, quantiles, share and criteria over all steps of the row's phase; sorts the scores. */
void scene_row_errors(ChartRow *row, const PhaseScores *scores);

/* Largest penetration and means of the other measures over measures[count], one per launch. */
void scene_row_measures(ChartRow *row, const RunMeasures *measures, int count);

/* cpu: that it was measured on; must outlive the row. */
void scene_row_cost(ChartRow *row, const StepCost *cost, const char *cpu);
