/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One network of the paper's study: trained, scored and stored. */
#pragma once
#include "network/network.h"
#include "paper/study/paper_data.h"

#include <stdio.h>

typedef struct PaperTraining {
    PaperDatasets *datasets;
    PaperNetwork network;
    const char *folder; /* of the trained networks */
    uint64_t seed;      /* of the first weights */
} PaperTraining;

/* Trains, writes folder/NAME.npz, and writes lines of the tables table1 and networks (study/piece_tables.h), and a note of
   the file's hash. A PaperPart's write(); context is the PaperTraining. A training that is stopped fails: the name is of a
   whole training. */
bool paper_training_write(void *context, FILE *lines, const Progress *progress, Error *error);

/* *there: whether folder/NAME.npz is the network of these lines. False with error set if the system cannot tell. */
bool paper_training_whole(const PaperTraining *training, const char *lines, bool *there, Error *error);

/* The share of test rows for which all outputs are within 5% of their range over the training rows; NaN without test rows.
   The paper does not define the accuracy of its gate (section 3: 90%); this is a guess. False with error set when memory is
   short. */
bool paper_accuracy(const Network *network, const Dataset *dataset, double *accuracy, Error *error);
