/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scores during training beside those of the paper's Table 1. */
#include "paper/findings/findings_tables.h"
#include "paper/study/aims.h"
#include "paper/study/published.h"

#include <math.h>
#include <string.h>

/* The constant predictor's error for a target on the paper's scale, [0, 1]; NAN if no network has that scale. */
static double constant_on_paper_scale(const StudyTables *study, PairTarget target) {
    for (int i = 0; i < study->network_count; i++) {
        const TrainedRow *row = &study->networks[i];
        if (row->target == (int)target && strcmp(row->scale, "minmax") == 0 && !isnan(row->constant))
            return row->constant;
    }
    return NAN;
}

/* The paper's score for a row's iteration. Only networks with a target of the paper's, on its scale, are comparable:
   NAN for others. */
static double paper_test(const StudyTables *study, const ScoreRow *row) {
    const TrainedRow *network = study_network(study, row->network);
    if (row->target >= PAPER_TARGETS || network == NULL || strcmp(network->scale, "minmax") != 0) return NAN;
    for (int i = 0; i < PUBLISHED_SCORES; i++)
        if (published_scores[i].iteration == row->iteration) return published_scores[i].test;
    return NAN;
}

typedef struct TargetRow {
    const char *target, *best; /* best: of the small networks */
    double constant, ratio;    /* the constant predictor's error on the paper's scale; test error of the best over it */
    int paper_rows_worse;      /* rows of the paper's Table 1 with a higher error than the constant predictor */
    int small_networks;
    /* Scores of the study, by how they compare with the constant predictor's and with the paper's for the iteration. */
    int rows, not_below_constant, compared, below_paper, below_both;
} TargetRow;

static void count_scores(const StudyTables *study, PairTarget target, TargetRow *counts) {
    for (int i = 0; i < study->score_count; i++) {
        const ScoreRow *row = &study->scores[i];
        if (row->target != (int)target) continue;
        const double paper = paper_test(study, row);
        counts->rows++;
        counts->not_below_constant += row->test >= row->constant;
        counts->compared += !isnan(paper);
        counts->below_paper += row->test < paper;
        counts->below_both += row->test < paper && row->test < row->constant;
    }
}

static bool write_targets(const FindingsFile *file, const StudyTables *study) {
    for (PairTarget target = 0; target < PAIR_TARGETS; target++) {
        TargetRow row = {.target = pair_target_names[target], .constant = constant_on_paper_scale(study, target)};
        const TrainedRow *best = study_best(study, target, NULL, SMALL_NETWORK, &row.small_networks);
        row.best = best != NULL ? best->network : "";
        row.ratio = best != NULL ? best->ratio : NAN;
        for (int i = 0; i < PUBLISHED_SCORES; i++) row.paper_rows_worse += published_scores[i].test > row.constant;
        count_scores(study, target, &row);
        if (row.rows > 0 && !findings_add(file, &row)) return false;
    }
    return true;
}

static const CsvColumn target_columns[] = {FINDINGS_TEXT(TargetRow, target),
                                           FINDINGS_NUMBER(TargetRow, constant),
                                           FINDINGS_COUNT(TargetRow, paper_rows_worse),
                                           FINDINGS_COUNT(TargetRow, small_networks),
                                           FINDINGS_TEXT(TargetRow, best),
                                           FINDINGS_NUMBER(TargetRow, ratio),
                                           FINDINGS_COUNT(TargetRow, rows),
                                           FINDINGS_COUNT(TargetRow, not_below_constant),
                                           FINDINGS_COUNT(TargetRow, compared),
                                           FINDINGS_COUNT(TargetRow, below_paper),
                                           FINDINGS_COUNT(TargetRow, below_both)};
const FindingsTable findings_targets = FINDINGS_TABLE("targets", target_columns, TargetRow, write_targets);

static bool write_paper_table1(const FindingsFile *file, const StudyTables *study) {
    (void)study;
    for (int i = 0; i < PUBLISHED_SCORES; i++)
        if (!findings_add(file, &published_scores[i])) return false;
    return true;
}

static const CsvColumn published_columns[] = {FINDINGS_NUMBER(PublishedScore, iteration),
                                              FINDINGS_NUMBER(PublishedScore, test),
                                              FINDINGS_NUMBER(PublishedScore, train)};
const FindingsTable findings_paper_table1 =
    FINDINGS_TABLE("paper_table1", published_columns, PublishedScore, write_paper_table1);
