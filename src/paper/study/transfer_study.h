/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Transfer learning, the paper's outlook: does a network that was trained on the single box and the stack need fewer
   launches of the pyramid than one trained from scratch? */
#pragma once
#include "common/progress.h"
#include "dataset/dataset.h"

/* All with one view and the target pair. single and stack may be NULL for training from scratch. */
typedef struct TransferData {
    const Dataset *single, *stack, *pyramid;
} TransferData;

/* The network is 10-10-2 (its inputs are the view's), with linear standardised outputs, trained with Adam. */
typedef struct TransferStudy {
    bool transfer;  /* false: from scratch. true: trained on single, then on stack, then on the pyramid */
    uint64_t seed;  /* of the initial weights and the drawn launches */
    int launches;   /* of the pyramid, to train on, drawn with the seed (dataset_draw_subset) */
    int iterations; /* of each stage; transfer has three stages, of which the pyramid is the last */
} TransferStudy;

/* RMS errors of the change of relative velocity, over both components, on held-out launches of the pyramid, m/s. */
typedef struct TransferResult {
    double error;    /* of the network */
    double constant; /* of the mean of the pyramid's training rows */
} TransferResult;

/* Trains in one or three stages. A network keeps the normalisation of its first stage (TrainingOptions.start): with
   transfer, the pyramid is learned in the units of the single box. Progress restarts with each stage. False with error
   set as by training_run, if there are fewer launches than `launches`, or if progress_report() stops it. */
bool transfer_study_run(const TransferData *data, const TransferStudy *study, TransferResult *result,
                        const Progress *progress, Error *error);
