/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The studies of the paper: networks, scores, rates, transfer, laws, and the systems that it cites. */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "learning/dataset.h"
#include "learning/pair_training.h"
#include "methods/pair.h"
#include "nets/nets.h"
#include "paper/paper.h"
#include "runs/pieces.h"
#include "scenes/scenes.h"
#include "studies/frozen.h"
#include "studies/rollout.h"

/* system_scores.csv: every system that the paper cites, with its ablations, and rivals, on held-out launches of the four
   scenes (launches_for_scoring). Each method runs on its own trajectory, from the start to the scene's last frame. */

enum { SYSTEM_SCORES_MAX = 400, SYSTEM_NAME_SIZE = 64 };

/* Sums and maxima are over all launches. NAN where a number is not applicable. */
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

extern const CsvLayout system_score_layout;

/* Training with laws of physics in the loss, and the engine's own violations of these laws: the paper's outlook. */

/* The network is the paper's 10-8-8-6 (3.1) by Adam, standardised, with the default activations. */
typedef struct LawStudy {
    const char *laws; /* none, momentum, energy, approach, cone, all; NULL: no network, the labels */
    double weight;    /* of each law */
    uint64_t seed;
    int iterations;
} LawStudy;

/* laws.csv: a training with laws in the loss; or the labels by themselves. NAN where a number is not applicable. */
typedef struct LawRow {
    int laws; /* of paper_law_words */
    double weight, seed;
    double test, constant;  /* mean squared error on the test rows, and the constant predictor's */
    double violation[LAWS]; /* means over the test rows (laws_measure), in the laws' units */
} LawRow;

/* Trains one network and fills the row; the dataset must have context (laws_check). Scores and violations are those of
   the network with the lowest loss on the training rows. Of the labels, if study->laws is NULL. False with error set as
   by training_run, or if progress_report() stops it. */
bool law_study_run(const Dataset *dataset, const LawStudy *study, LawRow *row, const Progress *progress, Error *error);

/* A scene with some of its held-out launches. */

enum { LAUNCHED_MAX = 64 };

typedef struct Launched {
    Scene *scene;
    int count;
    Scene *launches;      /* [count] launches_for_scoring() */
    SnapshotList *states; /* [count] empty until sampled */
} Launched;

/* count: at most LAUNCHED_MAX. ERROR_INPUT for a scene that cannot be read, or without a bomb or a family of launches.
   On failure nothing is to be freed. */
bool launched_begin(Launched *launched, const char *path, int count, Error *error);
void launched_free(Launched *launched);

/* Transfer learning, the paper's outlook: does a network that was trained on the single box and the stack need fewer
   launches of the pyramid than one trained from scratch? */

enum { TRANSFER_SCENES = 3 }; /* single, stack, pyramid: the first of paper_scene_names */

/* The network is 10-10-2 (its inputs are the view's), with linear standardised outputs, trained with Adam. */
typedef struct TransferStudy {
    bool transfer;  /* false: from scratch. true: trained on single, then on stack, then on the pyramid */
    uint64_t seed;  /* of the initial weights and the drawn launches */
    int launches;   /* of the pyramid, to train on, drawn with the seed (dataset_draw_subset) */
    int iterations; /* of each stage; transfer has three stages, of which the pyramid is the last */
} TransferStudy;

/* transfer.csv: a training. RMS errors of the change of relative velocity, over both components, on held-out launches
   of the pyramid, m/s. */
typedef struct TransferRow {
    int transfer; /* 0: from scratch */
    double seed, launches;
    double error;    /* of the network */
    double constant; /* of the mean of the pyramid's training rows */
} TransferRow;

/* Trains in one or three stages, on data of one view and the target pair; the first two may be NULL for training from
   scratch. A network keeps the normalisation of its first stage (TrainingOptions.start): with
   transfer, the pyramid is learned in the units of the single box. Progress restarts with each stage. False with error
   set as by training_run, if there are fewer launches than `launches`, or if progress_report() stops it. */
bool transfer_study_run(const Dataset *const data[TRANSFER_SCENES], const TransferStudy *study, TransferRow *row,
                        const Progress *progress, Error *error);

/* Rates of right predictions. The paper does not define its "successful prediction rate" (section 4: 60 to 91%), so
   this measures three definitions of it, on steps sampled from the engine's runs. Each rate is beside those
   of the constant predictor and of the engine with fewer sweeps:

     range     both components of a pair's change of relative velocity are within 5% of their range in the engine's
               sampled steps
     absolute  the change of relative velocity is within 0.1 m/s, as a vector
     bodies    bodies whose velocity after the step is right, compared with the reference (methods/reference.h)

   Networks with the target net or impulse are rated on net changes or single impulses. Single impulses are the engine's
   own visits, so all its rates are 1 for them. */

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

extern const char *const rate_definition_names[RATE_DEFINITIONS + 1]; /* ends in NULL */

/* Shares, 0 to 1; NAN without anything to count, or for a network that cannot take a step. RATE_ALL weights the phases
   by the inverse of their sampling. */
typedef struct PairRates {
    double share[RATE_DEFINITIONS][RATE_PHASES][RATE_COLUMNS];
} PairRates;

/* path: a network's file; NULL: the warm start, without a constant predictor. lists[count]: sampled by `sampling` from
   launches of the scene. */
bool pair_rates_measure(const char *path, const Scene *scene, const SnapshotList *lists, int count,
                        const Sampling *sampling, PairRates *rates, Error *error);

/* Sizes of the whole study, and of the quick one, which runs every part briefly. */

enum { PAPER_WEIGHTS = 5, PAPER_LAUNCHES = 8 };

typedef struct PaperSize {
    PaperDataSize data;
    int iterations; /* of every training, at most */
    int rate_launches, closed_launches, repetitions;
    Sampling sampling;
    int seeds, law_iterations, transfer_iterations; /* of the outlook */
    double weights[PAPER_WEIGHTS];                  /* of laws, ended by 0 */
    int launches[PAPER_LAUNCHES];                   /* of transfer, ended by 0 */
    /* Of the scores of systems. Frames of each run, at most, 0: the scene's; timed ones from the start,
       and after a later launch of the bomb as many from there. */
    int system_launches, system_frames, system_timed_frames, system_repetitions;
} PaperSize;

extern const PaperSize paper_whole_size, paper_quick_size;

/* What the study is to reach. */

enum {
    PAPER_TARGETS = 3,  /* TARGET_PAIR, TARGET_NET, TARGET_IMPULSE: the readings of what the paper's networks predict */
    SMALL_NETWORK = 500 /* parameters, at most, of the networks that the aims for targets are for */
};

/* For each target: the highest test error, over the constant predictor's, that its best network may have; 0: no aim. */
extern const double target_aims[PAIR_TARGETS];

/* The share of test rows for which all outputs are within 5% of their range over the training rows; NaN without test
   rows. The paper does not define the accuracy of its gate (section 3: 90%); this is a guess. False with error set when
   memory is short. */
bool paper_accuracy(const Network *network, const Dataset *dataset, double *accuracy, Error *error);

/* The paper's study as a list of parts, its pieces (runs/pieces.h): trained networks, their scores, the outlook, the
   systems. Each uses all threads by itself. */

typedef struct PaperPlan PaperPlan;
typedef struct PaperPart PaperPart;

/* Writes lines of the part's tables (studies/piece_tables.h). */
typedef bool PaperWrite(PaperPlan *plan, const PaperPart *part, FILE *lines, const Progress *progress, Error *error);

struct PaperPart {
    char name[PIECE_NAME_SIZE];
    double weight; /* about the seconds on two cores */
    bool timed;
    bool needs_networks; /* the trained ones, all of them */
    PaperWrite *write;
    int index; /* of the plan's network, for paper_training_write; of the scene, for scores */
    LawStudy laws;
    TransferStudy transfer;
};

/* paper_plan_free(), also after a failure. Parts point into it: it stays where it was made. */
struct PaperPlan {
    PiecePlan plan;
    PaperPart *parts; /* [count] the first train networks[network_count] */
    size_t count, capacity;
    const PaperOptions *options;
    const PaperSize *size;
    PaperDatasets datasets;
    char networks_folder[PAPER_PATH_SIZE];
    PaperNetwork *networks;
    int network_count;
    int64_t first_timed;  /* parts that are timed are done by one shard, so that times of a report are of one machine */
    const Pieces *pieces; /* to be set: what the plan is done by */
};

/* ERROR_INPUT for a scene that cannot be read. The options must outlive the plan. */
bool paper_plan_make(PaperPlan *plan, const PaperOptions *options, Error *error);
void paper_plan_free(PaperPlan *plan);

/* What the parts do. Trains a network, writes networks_folder/NAME.npz, its lines of table1 and networks, and a note of
   the file's hash. A training that is stopped fails: the name is of a whole training. */
PaperWrite paper_training_write;

/* networks_folder/NAME.npz of network i. */
bool paper_network_path(const PaperPlan *plan, int i, char path[PAPER_PATH_SIZE], Error *error);

/* *there: whether networks_folder/NAME.npz is the network of these lines. False with error set if the system cannot
   tell. */
bool paper_training_whole(const PaperPlan *plan, const PaperPart *part, const char *lines, bool *there, Error *error);

/* In one scene, on launches that none was trained on: the table rates of every network and of the warm start alone; the
   table closed_loop of every network that can take a step, and of solvers beside them; system_scores. */
PaperWrite paper_rates_write, paper_closed_loop_write, system_scores_write;

/* A row of laws or of transfer. */
PaperWrite paper_laws_write, paper_transfer_write;

/* The CSV files that the paper's study writes: their rows and layouts (base/csv.h), for the study and for the
   figures and the report that read them. NAN where a number is not applicable. */

enum { PAPER_MAX_ROWS = 5000, PAPER_MAX_NETWORKS = 200, PAPER_MAX_LOOPS = 240, PAPER_MAX_LAUNCHES = 1 << 20 };

/* Indices of paper_law_words: a law by itself (LawName), or one of these. */
enum { LAW_SET_ALL = LAWS, LAW_SET_NONE, LAW_SET_ENGINE, LAW_WORDS };
extern const char *const paper_law_words[LAW_WORDS + 1];

enum { PAPER_OPTIMIZERS = 4 };
extern const char *const paper_optimizer_words[PAPER_OPTIMIZERS + 1]; /* adam, gd, bfgs, lm */

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
    double unconverged; /* sampled steps of the scene that are left out, as the reference does not converge */
} RateRow;

/* closed_loop.csv: a network in place of the solver (studies/closed_loop.h). */
typedef struct ClosedLoopRow {
    const char *network; /* or a solver, as on the command line */
    int scene;           /* of paper_scene_names */
    double frames_until_apart, penetration_max, momentum_error, energy_ratio, us_step, us_step_engine, unconverged;
} ClosedLoopRow;

/* study.csv: what was done, as text. */
typedef struct FactRow {
    const char *key, *value;
} FactRow;

extern const CsvLayout paper_score_layout, paper_trained_layout, paper_rate_layout, paper_closed_loop_layout,
    paper_law_layout, paper_transfer_layout, paper_fact_layout;

/* Numbers that the paper states (Avatavului, Ifrim, Voncila 2023). */

enum { PUBLISHED_SCORES = 6 };

/* Table 1: mean squared errors after so many iterations. */
typedef struct PublishedScore {
    double iteration, test, train;
} PublishedScore;

extern const PublishedScore published_scores[PUBLISHED_SCORES];

/* A network goes into the engine if it is right in more than this share of cases (section 3). */
#define PUBLISHED_GATE 0.9

/* A training that fails if it is stopped: results of half a training must not enter the study. */

/* As training_run, but NULL with error set if progress_report() stops it. */
Network *whole_training(const Dataset *dataset, const TrainingOptions *options, const Progress *progress, Error *error);
