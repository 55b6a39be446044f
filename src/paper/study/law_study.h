/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What laws of physics in the loss do to a network, and what the engine itself does to them: the paper's outlook. */
#pragma once
#include "common/progress.h"
#include "training/training.h"

/* The network is the paper's 10-8-8-6 (3.1) by Adam, standardised, with the default activations. */
typedef struct LawStudy {
    const char *laws; /* none, momentum, energy, approach, cone, all */
    double weight;    /* of each of them */
    uint64_t seed;
    int iterations;
} LawStudy;

typedef struct LawResult {
    double test, constant; /* mean squared error on the test rows, and that of predicting the mean; NAN of the labels */
    LawNumbers violations; /* mean over the test rows (laws_measure), in the laws' units */
} LawResult;

/* One training; the dataset has context (laws_check). The scores are those of the network that is measured: the one with
   the lowest loss on the rows trained on. False with error set as training_run, or where progress asks to stop. */
bool law_study_train(const Dataset *dataset, const LawStudy *study, LawResult *result, const Progress *progress,
                     Error *error);

/* The labels' own violations. */
bool law_study_labels(const Dataset *dataset, LawResult *result, Error *error);
