/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the report states beyond the study's tables: counts, extremes, medians and verdicts, as CSV files in
   folder/findings.

     summary.csv       key, value: counts and extremes over all networks and runs
     targets.csv       each target: the constant predictor's error, the best small network, scores beside the paper's
     paper_table1.csv  the paper's Table 1
     factors.csv       each factor: its best network beside the baseline
     definitions.csv   each definition of a right prediction: how often a cheaper predictor is right as often
     laws.csv          each case of laws in the loss: medians over the seeds
     transfer.csv      each number of launches: medians over the seeds, and how many launches transfer needs
     aims.csv          the study's aims: whether they are reached
     claims.csv        the paper's claims about factors: the lowest error with and without
     systems.csv       each system that the paper cites: how many of its claims hold

   An empty field is a number that is not applicable. */
#pragma once
#include "common/error.h"

/* Reads the study's tables (paper/study/paper_tables.h) from the folder. ERROR_INPUT where one is missing or damaged,
   with path:line:column. */
bool findings_write(const char *folder, Error *error);
