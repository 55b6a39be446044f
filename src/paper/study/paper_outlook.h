/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's outlook (section 5) as parts of the study: laws of physics in the loss, and transfer learning. */
#pragma once
#include "paper/study/law_study.h"
#include "paper/study/paper_data.h"
#include "paper/study/transfer_study.h"

#include <stdio.h>

/* Datasets shared by the parts, recorded at their first use. Zero-initialise all but `datasets` and `bomb_x`. */
typedef struct PaperOutlook {
    const PaperDatasets *datasets;
    const char *bomb_x[3]; /* launches of single, stack and pyramid for transfer, m: "-5:5:0.5" */
    Dataset *laws;
    Dataset *scenes[3]; /* single, stack, pyramid */
} PaperOutlook;

void paper_outlook_free(PaperOutlook *outlook);

/* A row of laws.csv: a training, or with laws NULL the labels. context: a PaperLaws. */
typedef struct PaperLaws {
    PaperOutlook *outlook;
    LawStudy study;
} PaperLaws;

bool paper_laws_write(void *context, FILE *lines, const Progress *progress, Error *error);

/* A row of transfer.csv: a training. context: a PaperTransfer. */
typedef struct PaperTransfer {
    PaperOutlook *outlook;
    TransferStudy study;
} PaperTransfer;

bool paper_transfer_write(void *context, FILE *lines, const Progress *progress, Error *error);
