/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scores of the methods on the launches of a scene. Those of one launch are stored as bytes of this machine: the number of
   methods, the launch's residual, where each method's part ends, then the parts; so one method's is found at once. */
#pragma once
#include "study/chart_csv.h"
#include "study/rollout.h"

#include <stdio.h>

/* A method on one launch. Zero-initialise. */
typedef struct LaunchScores {
    StepScores steps[PROTOCOLS][PHASES];
    RunMeasures measures;
    int unconverged; /* of the reference solves in closed loop, one for each step, as in Rollout */
} LaunchScores;

void launch_scores_free(LaunchScores *scores);

/* Writes those of all methods, scores[count]. residual: m/s, the largest of the reference solves of frozen steps. */
void launch_scores_write(FILE *results, const LaunchScores *scores, int count, double residual);

/* What is stored of a launch. */
typedef struct StoredScores {
    const char *path; /* for messages */
    const char *bytes;
    size_t size;
    int count; /* methods */
    double residual;
} StoredScores;

/* Looks at stored results with so many methods. ERROR_INPUT if they are damaged. The bytes must outlive *stored. */
bool stored_scores_open(StoredScores *stored, const char *path, const char *bytes, size_t size, int count,
                        Error *error);

typedef struct PhaseScores {
    int count;
    double *error, *share; /* [count], as in StepScores */
    size_t error_capacity, share_capacity;
} PhaseScores;

/* A method on several launches. Zero-initialise. */
typedef struct MethodScores {
    PhaseScores steps[PROTOCOLS][PHASES];
    double worst[PHASES];  /* m/s: largest mean error of a launch in closed loop; NaN without a scored step */
    RunMeasures *measures; /* [launches] */
    int launches;
    int64_t solves, unconverged; /* reference solves in closed loop, as in Rollout */
    size_t measure_capacity;
} MethodScores;

/* Adds a launch. ERROR_INPUT if its part is damaged. */
bool method_scores_add(MethodScores *scores, const StoredScores *stored, int method, Error *error);
void method_scores_free(MethodScores *scores);
