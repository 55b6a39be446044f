/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The CSV files that the paper's study writes: their rows and layouts (base/csv.h), for the study and for the figures
   that read them. NAN where a number is not applicable.

     csv_table_read_from(&table, folder, &paper_rate_layout, &error);
     const RateRow *rows = table.rows; */
#pragma once
#include "base/csv.h"
#include "learning/pair_training.h"
#include "methods/pair.h"
#include "scenes/scenes.h"

enum { PAPER_MAX_ROWS = 20000, PAPER_MAX_NETWORKS = 2000, PAPER_MAX_LOOPS = 2000, PAPER_MAX_LAUNCHES = 1 << 20 };
enum { LAUNCHED_MAX = 64, SYSTEM_SCORES_MAX = 400, SYSTEM_NAME_SIZE = 64 };

enum { PAPER_SCENES = 4, PAPER_TRAINING_SCENES = 2 };

/* single, stack, pyramid, pyramid_settled, NULL; the first two are trained on. */
extern const char *const paper_scene_names[PAPER_SCENES + 1];

enum { PAPER_OPTIMIZERS = 4 };
extern const char *const paper_optimizer_words[PAPER_OPTIMIZERS + 1]; /* adam, gd, bfgs, lm */

/* networks.csv: a network trained on one split; the texts are those of a PaperNetwork. All errors of a network and of
   the constant (the mean of its training rows) are in the paper's units: means of squares, each output in its range
   over the training rows. So ratios of networks that were trained in other units compare. */
typedef struct TrainedRow {
    const char *network, *factor, *value, *inputs, *data, *labels;
    int target; /* PairTarget */
    const char *layers, *hidden, *output, *scale, *optimizer, *loss;
    double seed; /* of the split by launch, and of the first weights */
    double iterations, parameters, test, train, constant;
    double ratio;                           /* test over constant */
    double ratio_of[PAPER_TRAINING_SCENES]; /* on the test rows of one scene */
    double largest;                         /* share of the test error that its ten largest rows make */
    double accuracy;                        /* share of test rows whose outputs are all within 5% of their range */
} TrainedRow;

/* constants.csv: always predicting the mean of the training rows, in the units of networks.csv, on all rows. */
typedef struct ConstantRow {
    int target; /* PairTarget */
    double seed, rows, test, train;
    double test_of[PAPER_TRAINING_SCENES];
    double largest;
} ConstantRow;

/* table1.csv: errors during a training, in the units of networks.csv: of the networks that are trained in them. */
typedef struct ScoreRow {
    const char *network;
    double seed;
    int target; /* PairTarget */
    int optimizer;
    double iteration, test, train, constant; /* constant: the constant predictor's */
} ScoreRow;

/* The paper's Table 1: mean squared errors after so many iterations. */
enum { PUBLISHED_SCORES = 6 };
extern const struct PublishedScore { double iteration, test, train; } published_scores[PUBLISHED_SCORES];

/* rates.csv: shares of right predictions by definition, of a network and of what costs less (pair_rates_measure). */
typedef enum RateDefinition { RATE_RANGE, RATE_ABSOLUTE, RATE_BODIES, RATE_DEFINITIONS } RateDefinition;
typedef enum RateColumn {
    RATE_NETWORK,
    RATE_CONSTANT,
    RATE_ENGINE1,
    RATE_ENGINE4,
    RATE_ENGINE10,
    RATE_COLUMNS
} RateColumn;
enum { RATE_PHASES = PHASES + 1, RATE_ALL = PHASES };

typedef struct RateRow {
    const char *network;
    double seed;    /* of its split; NAN of the warm start */
    int scene;      /* of paper_scene_names */
    int definition; /* RateDefinition */
    int phase;      /* Phase, or RATE_ALL */
    double share[RATE_COLUMNS];
    double unconverged; /* sampled steps of the scene that are left out, as the reference does not converge */
} RateRow;

/* closed_loop.csv: a network in place of the solver (studies/closed_loop.h). */
typedef struct ClosedLoopRow {
    const char *network; /* or a solver, as on the command line */
    double seed;         /* of its split; NAN of a solver */
    int scene;           /* of paper_scene_names */
    double frames_until_apart, penetration_max, momentum_error, energy_ratio, unconverged;
    double us_step, us_step_engine; /* NAN but of the first split: all have the same cost */
} ClosedLoopRow;

/* laws.csv: a training with laws in the loss; or the labels by themselves. */
typedef struct LawRow {
    int laws; /* of paper_law_words */
    double weight, seed;
    double test, constant;  /* mean squares of the standardised outputs on the test rows, and the constant's */
    double violation[LAWS]; /* means over the test rows (laws_measure), in the laws' units */
} LawRow;

/* Indices of paper_law_words: a law by itself (LawName), or one of these. */
enum { LAW_SET_ALL = LAWS, LAW_SET_NONE, LAW_SET_ENGINE, LAW_WORDS };
extern const char *const paper_law_words[LAW_WORDS + 1];

/* transfer.csv: a training. RMS errors of the change of relative velocity, over both components, on held-out launches
   of the pyramid, m/s. */
typedef struct TransferRow {
    int transfer; /* 0: from scratch */
    double seed, launches;
    double error;    /* of the network */
    double constant; /* of the mean of the pyramid's training rows */
} TransferRow;

/* system_scores.csv: every system that the paper cites, with its ablations, and rivals, on held-out launches of the
   four scenes (launches_for_scoring). Each method runs on its own trajectory, from the start to the scene's last frame.
   Sums and maxima are over all launches. */
typedef struct SystemScoreRow {
    const char *system, *method; /* "sain", or "rival"; the method as on the command line */
    int scene;                   /* of paper_scene_names */
    double launches, frames;     /* how many; frames of each run */
    double frames_engine;        /* first frame in which a body is 0.1 m from its place in the engine's run; median over
                                    launches; `frames`: never */
    double frames_converged; /* the same of the run of the converged solver, over the launches of which it is known */
    double moved;            /* boxes that moved more than 0.5 m in the 5 s after the launch, mean (ChartRow) */
    double penetration_max;  /* m: the deepest contact */
    double energy_created;   /* J: the largest mechanical energy above that when the bomb was added; 0: never above */
    double momentum_error;   /* N s: momentum created per step (ContactSolution), mean */
    double fallback_share;   /* 0 to 1: steps with discarded outputs, beyond training, or solved by sweeps */
    double us_step;          /* microseconds per step of a held-out launch, everything counted: the whole step; of
                                    methods without contacts their own work (no_contacts in its description) */
    double us_step_engine;   /* of the engine, measured in turns with it */
    /* launches in which the converged run has an unconverged step before the method parts from it */
    double unconverged;
} SystemScoreRow;

/* study.csv: what was done, as text. */
typedef struct FactRow {
    const char *key, *value;
} FactRow;

extern const CsvLayout paper_trained_layout, paper_constant_layout, paper_score_layout, paper_rate_layout,
    paper_closed_loop_layout, paper_law_layout, paper_transfer_layout, system_score_layout, paper_fact_layout;
