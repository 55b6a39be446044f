/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scene of the speed-accuracy study: its launches, its methods, and the pieces of work on it. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "scenes/scenes.h"
#include "studies/chart_table.h"
#include "studies/contenders.h"
#include "studies/rollout.h"
#include "studies/timing.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* The launches that a study scores. */

/* At most one of them; none: a number of the scene's family that the study chooses. */
typedef struct LaunchChoice {
    const char *table; /* path (scenes/scenes.h); NULL: none */
    FloatRange bomb_x; /* m; count 0: none */
    int count;         /* of the scene's family; 0: not given */
} LaunchChoice;

/* One scene of the speed-accuracy study: its launches and the methods that are scored on them. */

typedef struct StudySize {
    int launches;            /* unless a table of launches is given */
    Sampling closed, frozen; /* steps to score */
    int timed_launches, repetitions;
} StudySize;

typedef struct SceneStudy {
    Scene *scene;
    int launch_count, contender_count;
    Launch *launches;             /* [launch_count] */
    int shared_steps;             /* of all launches: before the bomb appears */
    int striking_count;           /* of the launches: those that strike a box, by the engine; at least 1 */
    int *striking;                /* [striking_count] their places, rising */
    const Contender **contenders; /* [contender_count] available for this scene */
    /* [contender_count] Threads use them in turns, as some take seconds and much memory to be made. A stepper keeps
       nothing of a launch for the next, so the order of launches does not matter. */
    struct SharedStepper *steppers;
    SharedSteps converged; /* of the converged runs */
    bool no_push_out;      /* one of them is scored against converged velocities without push-out */
    StudySize size;
} SceneStudy;

/* Reads the scene and its launches. `size` is for scenes of up to 110 bodies; larger ones have fewer launches.
   ERROR_INPUT also if no launch strikes a box. */
bool scene_study_begin(SceneStudy *study, const char *path, const ContenderList *contenders,
                       const LaunchChoice *launches, const StudySize *size, Error *error);
void scene_study_end(SceneStudy *study);

/* Destroys the steppers, which no thread may use; they are made again when they are needed. */
void scene_study_rest(SceneStudy *study);

/* The number of launches whose times are measured, spread evenly over those that strike. */
int scene_study_timed(const SceneStudy *study);

/* A piece of the speed-accuracy study: a launch of a scene with all methods, which share its converged run and its
   frozen steps. */

/* Scores all contenders of the study on the launch, in parallel, and writes the scores. Called from
   several threads at once, it uses one thread each. */
bool launch_piece_write(SceneStudy *study, int launch, FILE *results, const Progress *progress, Error *error);

/* A piece of the speed-accuracy study: the times of all methods in a scene, measured in turns by one process. */

/* Of a method. */
typedef struct MethodTimes {
    StepCost costs[PROTOCOLS][PHASES];
} MethodTimes;

/* Measures the contenders of the study on some of its launches, and writes their times. */
bool scene_times_write(SceneStudy *study, FILE *results, const Progress *progress, Error *error);

/* The stored times of the contenders, to be freed. ERROR_INPUT if they are damaged. path: for messages. */
MethodTimes *scene_times_read(const SceneStudy *study, const char *path, const char *bytes, size_t size, Error *error);
