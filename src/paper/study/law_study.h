/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training with laws of physics in the loss, and the engine's own violations of these laws: the paper's outlook. */
#pragma once
#include "common/progress.h"
#include "training/training.h"

/* The network is the paper's 10-8-8-6 (3.1) by Adam, standardised, with the default activations. */
typedef struct LawStudy {
    const char *laws; /* none, momentum, energy, approach, cone, all */
    double weight;    /* of each law */
    uint64_t seed;
    int iterations;
} LawStudy;

typedef struct LawResult {
    double test, constant; /* mean squared error on the test rows, and the constant predictor's; NAN for labels */
    LawNumbers violations; /* means over the test rows (laws_measure), in the laws' units */
} LawResult;

/* Trains one network; the dataset must have context (laws_check). Scores and violations are those of the network with
   the lowest loss on the training rows. False with error set as by training_run, or if progress_report() stops it. */
bool law_study_train(const Dataset *dataset, const LawStudy *study, LawResult *result, const Progress *progress,
                     Error *error);

/* Measures the violations of the labels. */
bool law_study_labels(const Dataset *dataset, LawResult *result, Error *error);
