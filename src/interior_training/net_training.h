/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trains the network of interior-net on random scenes (random_scene.h). The first round records problems of runs by
   momentum and by interior, the later ones of runs by interior with the network so far, and fits all problems so far.
   Source: Ross, Gordon, Bagnell, "A Reduction of Imitation Learning and Structured Prediction to No-Regret Online
   Learning" (2011). */
#pragma once
#include "common/progress.h"
#include "interior_training/net_fit.h"
#include "pieces/pieces.h"

typedef struct NetScore {
    int round, epoch, problems;
    double loss;             /* mean over the round's problems in the last epoch */
    NetErrors with, without; /* held out: of other random scenes, impact frames only */
} NetScore;

typedef struct NetTraining {
    int scenes; /* per round */
    int rounds; /* at most NET_ROUNDS_MAX */
    int epochs; /* per round */
    uint64_t seed;
    const char *command;    /* names the training: only the same command resumes it */
    const char *state_path; /* where the state is stored, and read from if it exists. The caller removes it once it has
                               stored the network */
    const Pieces *recorded; /* what the first round runs is read from these (first_round.h); or NULL */
    /* Called after each round; may be NULL. */
    void (*on_score)(void *context, const NetScore *score);
    void *context;
} NetTraining;

/* False with error set if the state cannot be written or read, memory is short, or nothing was recorded. ERROR_INTERRUPTED if
   progress requests a stop: the state stays. Same bits for any number of threads, and however often it was interrupted. */
bool net_training_run(const NetTraining *training, InteriorNet *net, const Progress *progress, Error *error);
