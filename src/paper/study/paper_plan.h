/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's study as a list of parts, its pieces (pieces/pieces.h): trained networks, their scores, the outlook, the
   systems. Each uses all threads by itself. */
#pragma once
#include "paper/study/paper.h"
#include "paper/study/paper_outlook.h"
#include "paper/study/paper_scores.h"
#include "paper/study/paper_size.h"
#include "paper/study/paper_training.h"
#include "paper/systems/system.h"
#include "paper/systems/system_scores.h"

typedef struct PaperPart {
    char name[PIECE_NAME_SIZE];
    double weight; /* about the seconds on two cores */
    bool timed;
    bool needs_networks; /* the trained ones, all of them */
    bool (*write)(void *context, FILE *lines, const Progress *progress, Error *error);
    union {
        PaperTraining training;
        PaperScoring scoring;
        PaperLaws laws;
        PaperTransfer transfer;
        SystemWork system;
        SystemScoring scores;
    } of; /* the context of write */
} PaperPart;

/* paper_plan_free(), also after a failure. Parts point into it: it stays where it was made. */
typedef struct PaperPlan {
    PiecePlan plan;
    PaperPart *parts; /* [count] the first train networks[network_count] */
    size_t count, capacity;
    const PaperOptions *options;
    const PaperSize *size;
    PaperDatasets datasets;
    PaperOutlook outlook;
    SystemStudy systems;
    char networks_folder[PAPER_PATH_SIZE];
    PaperNetwork *networks;
    int network_count;
    int64_t first_timed;  /* parts that are timed are done by one shard, so that times of a report are of one machine */
    const Pieces *pieces; /* to be set: what the plan is done by */
} PaperPlan;

/* ERROR_INPUT for a scene that cannot be read. The options must outlive the plan. */
bool paper_plan_make(PaperPlan *plan, const PaperOptions *options, Error *error);
void paper_plan_free(PaperPlan *plan);
