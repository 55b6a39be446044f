/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The CSV files that the paper's study writes: their rows and layouts (csv/csv_table.h), for the study and for the
   figures and the report that read them. NAN where a number is not applicable. */
#pragma once
#include "csv/csv_table.h"
#include "paper/study/pair_rates.h"
#include "paper/study/paper_data.h"
#include "training/law_weights.h"

enum { PAPER_MAX_ROWS = 5000, PAPER_MAX_NETWORKS = 200, PAPER_MAX_LOOPS = 240, PAPER_MAX_LAUNCHES = 1 << 20 };

/* Indices of paper_law_words: a law by itself (LawName), or one of these. */
enum { LAW_SET_ALL = LAWS, LAW_SET_NONE, LAW_SET_ENGINE, LAW_WORDS };
extern const char *const paper_law_words[LAW_WORDS + 1];

enum { PAPER_OPTIMIZERS = 4 };
extern const char *const paper_optimizer_words[PAPER_OPTIMIZERS + 1]; /* adam, gd, bfgs, lm */

extern const char *const paper_phase_words[RATE_PHASES + 1]; /* impact, after, rest, all */

/* table1.csv: mean squared errors of normalised outputs during a training. */
typedef struct ScoreRow {
    const char *network;
    int target; /* PairTarget */
    int optimizer;
    double iteration, test, train, constant; /* constant: the constant predictor's */
} ScoreRow;

/* networks.csv: a trained network; the texts are those of a PaperNetwork. */
typedef struct TrainedRow {
    const char *network, *factor, *value, *inputs, *data, *labels;
    int target; /* PairTarget */
    const char *layers, *hidden, *output, *scale, *optimizer, *loss;
    double iterations, parameters, test, train, constant;
    double ratio;    /* test over constant */
    double accuracy; /* paper_accuracy() */
} TrainedRow;

/* rates.csv: shares of right predictions. */
typedef struct RateRow {
    const char *network;
    int scene;      /* of paper_scene_names */
    int definition; /* RateDefinition */
    int phase;      /* Phase, or RATE_ALL */
    double share[RATE_COLUMNS];
} RateRow;

/* closed_loop.csv: a network in place of the solver (study/closed_loop.h). */
typedef struct ClosedLoopRow {
    const char *network;
    int scene; /* of paper_scene_names */
    double frames_until_apart, penetration_max, momentum_error, energy_ratio, us_step, us_step_engine;
} ClosedLoopRow;

/* laws.csv: a training with laws in the loss (LawStudy, LawResult); or the labels by themselves. */
typedef struct LawRow {
    int laws; /* of paper_law_words */
    double weight, seed, test, constant;
    double violation[LAWS];
} LawRow;

/* transfer.csv: a training (TransferStudy, TransferResult). */
typedef struct TransferRow {
    int transfer; /* 0: from scratch */
    double seed, launches, error, constant;
} TransferRow;

/* study.csv: what was done, as text. */
typedef struct FactRow {
    const char *key, *value;
} FactRow;

extern const CsvLayout paper_score_layout, paper_trained_layout, paper_rate_layout, paper_closed_loop_layout,
    paper_law_layout, paper_transfer_layout, paper_fact_layout;
