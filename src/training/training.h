/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trains a pair network on a dataset as the paper does (3.2, 3.3): full-batch mean squared error of normalised
   outputs. */
#pragma once
#include "common/error.h"
#include "common/progress.h"
#include "dataset/dataset.h"
#include "network/network.h"

typedef struct TrainingScore {
    int iteration;
    double test, train;       /* mean squared error of the normalised outputs */
    double constant_test, constant_train; /* of predicting the training mean */
} TrainingScore;

typedef struct TrainingOptions {
    int layers;                         /* weight layers */
    int widths[NETWORK_MAX_LAYERS + 1]; /* first 10, last 2 or 6 */
    const char *optimizer;              /* a name of the optimiser table: adam, bfgs, lm */
    int iterations;                     /* full-batch steps */
    uint64_t seed;                      /* of the initial weights */
    /* Called with the scores at iterations 0, 10, 50, 100, 1000, 2000, ... and the last one. */
    void (*on_score)(void *context, const TrainingScore *score);
    void *context;
    const Network *start;               /* go on from these weights, or NULL */
} TrainingOptions;

/* NULL with error set: shapes that do not fit, memory, or training that left the finite numbers (with the
   iteration). When progress asks to stop, returns the best network so far. */
Network *training_run(const Dataset *dataset, const TrainingOptions *options, const Progress *progress,
                      Error *error);
