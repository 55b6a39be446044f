/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training of pair networks on a dataset.

       Network *network = training_run(dataset, &options, progress, error);
       bool ok = network != NULL && network_write(network, "net.npz", error); */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "learning/dataset.h"
#include "learning/pair_laws.h"
#include "nets/nets.h"

/* Trains a pair network on a dataset: full batch, mean squared error of normalised outputs, as in the paper (3.2, 3.3).
   Beyond the paper: a robust loss and physics-informed terms. */

typedef struct TrainingScore {
    int iteration;
    double test, train;                   /* loss of the normalised outputs, without the laws' terms */
    double constant_test, constant_train; /* loss of the constant predictor (training mean) */
} TrainingScore;

typedef struct TrainingOptions {
    int layers;                         /* weight layers */
    int widths[NETWORK_MAX_LAYERS + 1]; /* first 10, last 2 or 6 */
    const char *optimizer;              /* a name of the optimiser table: adam, bfgs, gd, lm */
    int iterations;                     /* full-batch steps */
    int patience;  /* ends when the held-out error has not fallen by 0.1% in so many steps; 0: never before the last */
    uint64_t seed; /* of the initial weights */
    /* Names; NULL selects the first unless stated: */
    const char *hidden;            /* activation of the hidden layers: sigmoid, tanh, relu */
    const char *output_activation; /* sigmoid, linear; NULL: sigmoid for two outputs, linear for six */
    const char *scale;             /* of outputs: minmax, standard; NULL: minmax with sigmoid, standard with linear */
    const char *loss;              /* mse, smooth-l1 */
    LawNumbers laws;               /* weights of the laws in the loss */
    /* Called at iterations 0, 10, 50, 100, 1000, 2000, 5000, 10000, ... and the last one; may be NULL. */
    void (*on_score)(void *context, const TrainingScore *score);
    void *context;
    const Network *start; /* continue from its weights, activations and normalisation; or NULL */
} TrainingOptions;

/* Networks with two outputs learn the change of b's velocity relative to a; the defaults are min-max scaling and
   sigmoids in all layers (paper, 3.2). Networks with six outputs learn pair_changes(), by default standardised with a
   linear last layer (3.1). Inputs are standardised. All normalisations come from the training rows.

   Returns the network with the lowest train loss, also if progress stops the training early or the optimiser cannot
   lower the loss further. `command` is left empty. Same bits for any number of threads.

   A start network keeps its normalisation, whatever the rows: its weights are only valid with it. Its scores are in its
   own units.

   NULL with error set: options that do not match the dataset (training_check), memory, or divergence: a NaN or infinite
   parameter or loss (the message names the iteration). */
Network *training_run(const Dataset *dataset, const TrainingOptions *options, const Progress *progress, Error *error);

/* Scores a network with the named loss (NULL: mse), in the units of its own normalisation; iteration is 0. (on_score
   reports the latest weights; training_run() returns the best.) Errors as training_run with this start network. */
bool training_score(const Dataset *dataset, const Network *network, const char *loss, TrainingScore *score,
                    Error *error);
