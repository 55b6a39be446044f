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
   write(); context is the PaperTraining. */
bool paper_training_write(void *context, FILE *lines, const Progress *progress, Error *error);

/* The share of held-out rows of which all outputs are within 5% of their range over the rows trained on: the paper's
   accuracy, as far as it can be guessed (section 3's gate is 90%). */
double paper_accuracy(const Network *network, const Dataset *dataset);
