/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trains a pair network on a dataset as the paper does (3.2, 3.3): full-batch mean squared error of
   normalised outputs. */
#pragma once
#include "common/error.h"
#include "common/progress.h"
#include "dataset/dataset.h"
#include "network/network.h"

typedef struct TrainingScore {
    int iteration;
    double test, train;                   /* mean squared error of the normalised outputs */
    double constant_test, constant_train; /* of predicting the training mean */
} TrainingScore;

typedef struct TrainingOptions {
    int layers;                         /* weight layers */
    int widths[NETWORK_MAX_LAYERS + 1]; /* first 10, last 2 or 6 */
    const char *optimizer;              /* a name of the optimiser table: adam, bfgs, gd, lm */
    int iterations;                     /* full-batch steps */
    uint64_t seed;                      /* of the initial weights */
    /* Words, NULL for the first: */
    const char *hidden;            /* activation of the hidden layers: sigmoid, tanh, relu */
    const char *output_activation; /* sigmoid, linear; NULL: sigmoid for two outputs, linear for six */
    const char *scale;             /* of outputs: minmax, standard; NULL: minmax with sigmoid, standard with linear */
    /* Called with the scores of the weights at iterations 0, 10, 50, 100, 1000, 2000, 5000, 10000, ... and
       the last one; may be NULL. */
    void (*on_score)(void *context, const TrainingScore *score);
    void *context;
    const Network *start; /* go on from these weights, with its activations and normalisation, or NULL */
} TrainingOptions;

/* Two outputs learn the change of the velocity of b relative to a, left to the defaults min-max normalised with
   sigmoids throughout (paper, 3.2); six learn pair_changes(), standardised with a linear last layer (3.1). Inputs
   are standardised. All normalisations come from the rows to train on.

   Returns the network with the lowest train loss seen, also when progress asks to stop early or an optimiser
   finds no way on; its `command` is left empty. The same bits at any number of threads.

   NULL with error set: shapes or words that do not fit, no rows to train on or to test on, memory, or training that
   diverged: left the finite numbers (with the iteration). */
Network *training_run(const Dataset *dataset, const TrainingOptions *options, const Progress *progress, Error *error);
