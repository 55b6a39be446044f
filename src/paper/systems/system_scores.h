/* SPDX-License-Identifier: GPL-3.0-or-later */
/* system_scores.csv: every system with its ablations, and rivals, on held-out launches of the four scenes
   (launches_for_scoring). Each method runs on its own trajectory, from the start to the scene's last frame. */
#pragma once
#include "csv/csv_table.h"
#include "paper/study/paper_data.h"

#include <stdio.h>

enum { SYSTEM_SCORES_MAX = 400, SYSTEM_NAME_SIZE = 64 };

/* The word for rivals in the column `system`. */
#define SYSTEM_RIVAL "rival"

/* Sums and maxima are over all launches. NAN where a number is not applicable. */
typedef struct SystemScoreRow {
    const char *system, *method; /* PaperSystem.name, or SYSTEM_RIVAL; the method as on the command line */
    int scene;                   /* of paper_scene_names */
    double launches, frames;     /* how many; frames of each run */
    double frames_engine;        /* first frame in which a body is 0.1 m from its place in the engine's run; median over
                                    launches; `frames`: never */
    double frames_converged;     /* the same of the run of the converged solver */
    double moved;                /* boxes that moved more than 0.5 m in the 5 s after the launch, mean (ChartRow) */
    double penetration_max;      /* m: the deepest contact */
    double energy_created; /* J: the largest mechanical energy above that when the bomb was added; 0: never above */
    double momentum_error; /* N s: momentum created per step (ContactSolution), mean */
    double fallback_share; /* 0 to 1: steps with discarded outputs, beyond training, or solved by sweeps */
    double us_step;        /* microseconds per step of a held-out launch, everything counted: the whole step; of
                                    methods without contacts their own work (no_contacts in method_description.h) */
    double us_step_engine; /* of the engine, measured in turns with it */
} SystemScoreRow;

extern const CsvLayout system_score_layout;

struct PaperSystem;

typedef struct SystemScoring {
    const struct PaperSystem *const *systems; /* ended by NULL */
    int scene;                                /* of paper_scene_names */
    const char *path;                         /* of the scene's file */
    int launches;
    int frames;       /* of each run, at most; 0: the scene's */
    int timed_frames; /* from the start, and after a later launch of the bomb as many from there */
    int repetitions;  /* of the time measurements */
} SystemScoring;

/* Lines of system_scores of one scene, as a part of the study. context: a SystemScoring. */
bool system_scores_write(void *context, FILE *lines, const Progress *progress, Error *error);

/* The score of a method in a scene of paper_scene_names; NULL: it has none. */
const SystemScoreRow *system_score_find(const SystemScoreRow *rows, int count, const char *method, int scene);
