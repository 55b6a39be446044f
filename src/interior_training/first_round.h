/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The random scenes of a training of interior-net that run without the network: those that are held out, and those of the first
   round. They can be recorded in pieces (pieces/pieces.h), and be read by the training. */
#pragma once
#include "impact_training/impact_problems.h"
#include "interior_training/net_training.h"
#include "pieces/piece_ranges.h"

typedef enum FirstSet { FIRST_HELD_OUT, FIRST_TRAINED, FIRST_SETS } FirstSet;

typedef struct FirstRound {
    const NetTraining *training;
    PieceRanges ranges; /* a group of scenes for each set */
    PiecePlan plan;
} FirstRound;

/* The training must outlive the round, which must stay where it is. */
void first_round_make(FirstRound *round, const NetTraining *training);

/* Appends the problems of a set, in the order of scenes: from training->recorded, or by running the scenes. */
bool first_round_take(const FirstRound *round, FirstSet set, ImpactProblems *problems, const Progress *progress,
                      Error *error);
