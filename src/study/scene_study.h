/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One scene of the speed-accuracy study. */
#pragma once
#include "study/contenders.h"
#include "study/frozen.h"
#include "study/launch_choice.h"
#include "study/timing.h"

typedef struct StudySize {
    int launches;            /* unless a table of launches is given */
    Sampling closed, frozen; /* steps to score */
    int timed_launches, repetitions;
} StudySize;

typedef struct SceneStudy {
    Scene *scene;
    int launch_count, contender_count;
    Scene *launches;              /* [launch_count] launched scenes */
    const Contender **contenders; /* [contender_count] available for this scene */
    RunLog *converged;            /* [launch_count] */
    SnapshotList *snapshots;      /* [launch_count] */
    StudySize size;
    double frozen_residual;  /* m/s: largest residual of the reference solves of frozen steps */
    int solves, unconverged; /* reference solves in closed loop */
} SceneStudy;

/* Reads the scene and its launches. `size` is for scenes of up to 110 bodies; larger ones have fewer launches. */
bool scene_study_begin(SceneStudy *study, const char *path, const ContenderList *contenders,
                       const LaunchChoice *launches, const StudySize *size, Error *error);
void scene_study_end(SceneStudy *study);

/* Computes the converged run and the frozen steps of every launch. */
bool scene_study_prepare(SceneStudy *study, const Progress *progress, Error *error);

enum { ROWS_EACH = PROTOCOLS * PHASES };

/* Scores one contender into rows[ROWS_EACH]; costs stay NaN. Thread-safe. */
bool scene_study_score(SceneStudy *study, int contender, ChartRow *rows, Error *error);

/* Measures the costs of rows[contender_count * ROWS_EACH]. */
bool scene_study_time(SceneStudy *study, ChartRow *rows, const Progress *progress, Error *error);
