/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rates and closed-loop runs of the networks in one scene, as parts of the study (paper_plan.h). */
#pragma once
#include "paper/study/paper_data.h"
#include "study/rollout.h"

#include <stdio.h>

typedef struct PaperScoring {
    int scene;                    /* of paper_scene_names */
    const char *path;             /* of the scene's file */
    const char *folder;           /* of the trained networks */
    const PaperNetwork *networks; /* [count] */
    int count;
    int rate_launches, closed_launches; /* launches to score on; none is a training launch */
    Sampling sampling;
    int repetitions; /* of the time measurements */
} PaperScoring;

/* Lines of the table rates: every network, and the warm start alone. context: a PaperScoring. */
bool paper_rates_write(void *context, FILE *lines, const Progress *progress, Error *error);

/* Lines of the table closed_loop: every network that can take a step. */
bool paper_closed_loop_write(void *context, FILE *lines, const Progress *progress, Error *error);
