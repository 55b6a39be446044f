/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Transfer learning, the paper's outlook: does a network that knows the single box and the stack need fewer launches of
   the pyramid to learn it than one that begins there? */
#pragma once
#include "common/progress.h"
#include "dataset/dataset.h"

/* Of one view and the target pair; those of single and stack may be NULL from scratch. */
typedef struct TransferData {
    const Dataset *single, *stack, *pyramid;
} TransferData;

/* A network of 10-10-2 (with as many inputs as the view has), linear standardised outputs, by Adam. */
typedef struct TransferStudy {
    bool transfer;  /* false: from scratch. true: trained on single, then on stack, then on the pyramid */
    uint64_t seed;  /* of the first weights, and of which launches are drawn */
    int launches;   /* how many of the pyramid's launches to train on, drawn with the seed (dataset_draw_subset) */
    int iterations; /* of each stage: with transfer three times as many in all, of which the pyramid sees the same */
} TransferStudy;

/* Root of the mean over held-out launches of the pyramid of the squared error of the change of relative velocity, over
   both its components, m/s. */
typedef struct TransferResult {
    double error;    /* of the network */
    double constant; /* of the mean of the rows of the pyramid trained on */
} TransferResult;

/* One training, of one or three stages. A network that goes on keeps the normalisation of its first stage
   (TrainingOptions.start), so the units that the pyramid is learned in are those of the single box. False with error set
   as training_run, where there are not so many launches, or where progress asks to stop; progress runs over each stage
   by itself. */
bool transfer_study_run(const TransferData *data, const TransferStudy *study, TransferResult *result,
                        const Progress *progress, Error *error);
