/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The paper's outlook, counted: what laws in the loss and transfer learning bring. */
#pragma once
#include "paper/findings/study_tables.h"

/* Of the cases with a single law in the loss and a positive weight, beside the network without laws. */
typedef struct LawCounts {
    int cases, obeyed, better; /* obeyed: the median violation of that law is lower; better: the median test error is */
} LawCounts;

LawCounts law_counts(const StudyTables *study);

/* Of the numbers of launches above the lowest. */
typedef struct TransferCounts {
    int rows, saved;                    /* saved: fewer launches suffice with transfer */
    double constant, scratch, transfer; /* errors, m/s: of the constant predictor; the lowest medians; NAN if unknown */
} TransferCounts;

TransferCounts transfer_counts(const StudyTables *study);
