/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Trains a pair network on a dataset as the paper does (3.2, 3.3): full-batch mean squared error of
   normalised outputs; or, beyond it, by another loss and with laws of physics in it. */
#pragma once
#include "common/error.h"
#include "common/progress.h"
#include "dataset/dataset.h"
#include "network/network.h"
#include "training/laws.h"

typedef struct TrainingScore {
    int iteration;
    double test, train;                   /* loss of the normalised outputs, without what the laws add */
    double constant_test, constant_train; /* that of predicting the training mean */
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
    const char *loss;              /* of outputs (loss.h): mse, smooth-l1 */
    LawNumbers laws;               /* weights of the laws in the loss (laws.h); 0: without */
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

   Going on, a network keeps the normalisation that it has, whatever the rows: what it has learned would mean something
   else in another. Scores of it are in its own units.

   NULL with error set: shapes or words that do not fit, laws that the dataset cannot say (laws_check), no rows to train
   on or to test on, memory, or training that diverged: left the finite numbers (with the iteration). */
Network *training_run(const Dataset *dataset, const TrainingOptions *options, const Progress *progress, Error *error);

/* Scores of a network, in the units of its own normalisation, by a loss in words (NULL: mse); iteration 0. The scores
   that a training reports are those of its last weights, not of the best that it returns. Errors as training_run, of
   going on from this network. */
bool training_score(const Dataset *dataset, const Network *network, const char *loss, TrainingScore *score,
                    Error *error);
