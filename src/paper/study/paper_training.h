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

/* Trains, writes folder/NAME.npz, and writes lines of the tables table1 and networks (study_parts.h). A StudyPart's
   write(); context is the PaperTraining. A training that is stopped fails: the name is of a whole training. */
bool paper_training_write(void *context, FILE *lines, const Progress *progress, Error *error);

/* The share of test rows for which all outputs are within 5% of their range over the training rows; NaN without test rows.
   The paper does not define the accuracy of its gate (section 3: 90%); this is a guess. False with error set when memory is
   short. */
bool paper_accuracy(const Network *network, const Dataset *dataset, double *accuracy, Error *error);
