/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tables that the study wrote into its folder, read again, and look-ups in them. */
#pragma once
#include "paper/study/paper_tables.h"
#include "paper/systems/system_claims.h"

enum { STUDY_TABLES = 8 };

typedef struct StudyTables {
    const ScoreRow *scores;
    const TrainedRow *networks;
    const RateRow *rates;
    const ClosedLoopRow *runs;
    const LawRow *laws;
    const TransferRow *transfers;
    const SystemScoreRow *system_scores;
    const ClaimRow *claims;
    int score_count, network_count, rate_count, run_count, law_count, transfer_count, system_score_count, claim_count;
    CsvTable tables[STUDY_TABLES]; /* owns the rows */
} StudyTables;

/* On failure nothing is to be freed. */
bool study_tables_read(StudyTables *study, const char *folder, Error *error);
void study_tables_free(StudyTables *study);

/* NULL if no network has that name. */
const TrainedRow *study_network(const StudyTables *study, const char *name);

/* The baseline; NULL if the study has none, or none with a ratio. */
const TrainedRow *study_baseline(const StudyTables *study);

/* Whether the network was trained for this factor. */
bool study_has_factor(const StudyTables *study, const char *network, const char *factor);

/* The network for a target with the lowest ratio, of those with at most max_parameters. factor: NULL for all. NULL if
   there is none. *among: how many it was chosen from. */
const TrainedRow *study_best(const StudyTables *study, PairTarget target, const char *factor, double max_parameters,
                             int *among);

/* The row of another network with the scene, definition and phase of this one; NULL if there is none. */
const RateRow *study_rate_of(const StudyTables *study, const char *network, const RateRow *row);

/* NAN unless b is positive. */
double ratio_of(double a, double b);
