/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The study as a list of parts, its pieces (runs/pieces.h): trained networks, their scores, the outlook, the systems.
   Trainings take one thread each; scores, which follow, use all.

     paper_plan_make(&plan, &options, &error);
     plan.parts[0].write(&plan, &plan.parts[0], lines, &progress, &error); */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "learning/dataset.h"
#include "learning/pair_training.h"
#include "methods/pair.h"
#include "nets/nets.h"
#include "paper/paper.h"
#include "paper/paper_tables.h"
#include "runs/pieces.h"
#include "scenes/scenes.h"
#include "studies/rollout.h"

#include <stdio.h>

enum { PAPER_PATH_SIZE = 4096, PAPER_DATASETS_MAX = 32 };

/* The networks: a baseline, and others that differ from it in one factor each. The paper's own words for the baseline:
   ten inputs made of differences of positions (3.1), one hidden layer of ten, two outputs, sigmoids throughout, outputs
   scaled to [0, 1] (3.2), the sweep of launches (3.3). */

/* Recorded launches of the single box and of the stack: 201 of each, at the paper's places, random, or half of both;
   and the first with more of their rows. */
typedef enum PaperData { DATA_SWEPT, DATA_RANDOM, DATA_MIXED, DATA_DENSE, PAPER_DATA } PaperData;

/* Words are those of learning/pair_training.h. Zero-initialised members are the baseline's: swept, labels by the
   engine, relative, pair, sigmoid, mse. */
typedef struct PaperNetwork {
    const char *name, *factor, *value; /* value: of the factor in which it differs from the baseline */
    PaperData data;
    DatasetLabels labels;
    PairView view;
    PairTarget target;
    const char *layers; /* "10-10-2" */
    const char *hidden, *output, *scale, *optimizer, *loss;
    int iterations; /* 0: 2000, as the paper's Table 1 */
    bool quick;     /* also part of the quick study */
} PaperNetwork;

extern const PaperNetwork paper_networks[];
extern const int paper_network_count;

/* With all defaults set. */
PaperNetwork paper_network(int i);

/* Single impulses with inputs by contact would need impulses at points: such a network cannot take a step. */
static inline bool network_takes_steps(PairTarget target, PairView view) {
    return target != TARGET_IMPULSE || !pair_views[view].by_contact;
}

/* The datasets, each recorded at its first use. */

/* Launches of each scene. */
typedef struct PaperDataSize {
    const char *swept, *mixed, *transfer; /* m: "-5:5:0.05" */
    int random, mixed_random;             /* launches drawn at random, in addition */
    /* Only every so many rows of a launch are kept, to save time, and every so many of DATA_DENSE; of single impulses,
       of which there are ten times as many. All are prime: they share no factor with the pairs of a resting stack. */
    int every, dense_every, impulse_every, impulse_dense_every;
} PaperDataSize;

typedef struct StoredDataset {
    int first, count; /* scenes */
    DatasetOptions options;
    Dataset *dataset;
} StoredDataset;

/* Zero-initialise. */
typedef struct PaperDatasets {
    char scenes[PAPER_SCENES][PAPER_PATH_SIZE];
    const PaperDataSize *size;
    uint64_t seed;
    int count;
    StoredDataset items[PAPER_DATASETS_MAX];
} PaperDatasets;

/* scenes: the folder of the four scene files. */
bool paper_datasets_begin(PaperDatasets *datasets, const char *scenes, const PaperDataSize *size, uint64_t seed,
                          Error *error);
void paper_datasets_free(PaperDatasets *datasets);

/* The dataset of a network, owned by `datasets`. NULL with error set. May be called by several threads. */
const Dataset *paper_dataset(PaperDatasets *datasets, const PaperNetwork *network, Error *error);

/* The same with all rows; of single impulses, with every so many as the others are thinned. */
const Dataset *paper_dataset_whole(PaperDatasets *datasets, const PaperNetwork *network, Error *error);

/* A view of a dataset with another split by launch. */
typedef struct SplitDataset {
    Dataset dataset; /* its arrays are those of the whole, but for launch_test */
    uint8_t *test;   /* owned */
} SplitDataset;

/* As dataset_split(). NULL datasets fail: their error is set. */
bool split_begin(SplitDataset *split, const Dataset *whole, uint64_t seed, Error *error);
void split_free(SplitDataset *split);

/* Sizes of the whole study, and of the quick one, which runs every part briefly. */

enum { PAPER_WEIGHTS = 5, PAPER_LAUNCHES = 8 };

typedef struct PaperSize {
    PaperDataSize data;
    int splits;          /* of launches, each with first weights by the same seed: of every network */
    int scored_splits;   /* of them, the first: rated, and used as the solver */
    int constant_splits; /* of the constant predictor, which costs nothing */
    int iterations;      /* of every training, at most */
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

/* Training with laws of physics in the loss, and the engine's own violations of these laws: the paper's outlook. */

/* The network is the paper's 10-8-8-6 (3.1) by Adam, standardised, with the default activations. */
typedef struct LawStudy {
    const char *laws; /* none, momentum, energy, approach, cone, all; NULL: no network, the labels */
    double weight;    /* of each law */
    uint64_t seed;
    int iterations;
} LawStudy;

/* Trains one network and fills the row; the dataset must have context (laws_check). Scores and violations are those of
   the network with the lowest loss on the training rows. Of the labels, if study->laws is NULL. False with error set as
   by training_run, or if progress_report() stops it. */
bool law_study_run(const Dataset *dataset, const LawStudy *study, LawRow *row, const Progress *progress, Error *error);

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

/* Trains in one or three stages, on data of one view and the target pair; the first two may be NULL for training from
   scratch. A network keeps the normalisation of its first stage (TrainingOptions.start): with
   transfer, the pyramid is learned in the units of the single box. Progress restarts with each stage. False with error
   set as by training_run, if there are fewer launches than `launches`, or if progress_report() stops it. */
bool transfer_study_run(const Dataset *const data[TRANSFER_SCENES], const TransferStudy *study, TransferRow *row,
                        const Progress *progress, Error *error);

typedef struct PaperPlan PaperPlan;
typedef struct PaperPart PaperPart;

/* Writes lines of the part's tables (studies/piece_tables.h). */
typedef bool PaperWrite(PaperPlan *plan, const PaperPart *part, FILE *lines, const Progress *progress, Error *error);

struct PaperPart {
    char name[PIECE_NAME_SIZE];
    double weight;       /* about the seconds on two cores */
    bool alone, timed;   /* as in PieceInfo */
    bool needs_networks; /* the trained ones, all of them */
    PaperWrite *write;
    int index;     /* of the plan's network, for paper_training_write; of the scene, for scores; of the target */
    uint64_t seed; /* of the split and the weights of a network */
    LawStudy laws;
    TransferStudy transfer;
};

/* paper_plan_free(), also after a failure. Parts point into it: it stays where it was made. */
struct PaperPlan {
    PiecePlan plan;
    PaperPart *parts; /* [count] the first train networks[network_count], each in all splits */
    size_t count, capacity;
    const PaperOptions *options;
    const PaperSize *size;
    PaperDatasets datasets;
    char networks_folder[PAPER_PATH_SIZE];
    PaperNetwork *networks;
    int network_count;
    const Pieces *pieces; /* to be set: what the plan is done by */
};

/* ERROR_INPUT for a scene that cannot be read. The options must outlive the plan. */
bool paper_plan_make(PaperPlan *plan, const PaperOptions *options, Error *error);
void paper_plan_free(PaperPlan *plan);

/* What the parts do. Trains a network on one split, writes networks_folder/NAME-SEED.npz, its lines of table1 and
   networks, and a note of the file's hash. A training that is stopped fails: the name is of a whole training. */
PaperWrite paper_training_write;

/* A table of always predicting the mean, on all rows of the paper's launches. */
PaperWrite paper_constants_write;

/* networks_folder/NAME-SEED.npz of network i. */
bool paper_network_path(const PaperPlan *plan, int i, uint64_t seed, char path[PAPER_PATH_SIZE], Error *error);

/* *there: whether networks_folder/NAME-SEED.npz is the network of these lines. False with error set if the system
   cannot tell. */
bool paper_training_whole(const PaperPlan *plan, const PaperPart *part, const char *lines, bool *there, Error *error);

/* In one scene, on launches that none was trained on: the table rates of every network and of the warm start alone; the
   table closed_loop of every network that can take a step, and of solvers beside them; system_scores. */
PaperWrite paper_rates_write, paper_closed_loop_write, system_scores_write;

/* A row of laws or of transfer. */
PaperWrite paper_laws_write, paper_transfer_write;

/* A scene with some of its held-out launches. */

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

/* Rates of right predictions. The paper does not define its "successful prediction rate" (section 4: 60 to 91%), so
   this measures three definitions of it, on steps sampled from the engine's runs. Each rate is beside those
   of the constant predictor and of the engine with fewer sweeps:

     range     both components of a pair's change of relative velocity are within 5% of their range in the engine's
               sampled steps
     absolute  the change of relative velocity is within 0.1 m/s, as a vector
     bodies    bodies whose velocity after the step is right, compared with the reference (methods/reference.h)

   Networks with the target net or impulse are rated on net changes or single impulses. Single impulses are the engine's
   own visits, so all its rates are 1 for them. */

/* Shares, 0 to 1; NAN without anything to count, or for a network that cannot take a step. RATE_ALL weights the phases
   by the inverse of their sampling. */
typedef struct PairRates {
    double share[RATE_DEFINITIONS][RATE_PHASES][RATE_COLUMNS];
} PairRates;

/* path: a network's file; NULL: the warm start, without a constant predictor. lists[count]: sampled by `sampling` from
   launches of the scene. */
bool pair_rates_measure(const char *path, const Scene *scene, const SnapshotList *lists, int count,
                        const Sampling *sampling, PairRates *rates, Error *error);

enum { LARGEST = 10, ROW_KINDS = PAPER_TRAINING_SCENES + 1, TRAIN_ROWS = PAPER_TRAINING_SCENES };

/* Squared errors, each the mean over the outputs. */
typedef struct RowErrors {
    double network[ROW_KINDS], constant[ROW_KINDS], rows[ROW_KINDS]; /* sums: test rows of a scene; training rows */
    double largest[LARGEST];                                         /* of the network's test rows, falling */
    double right;                                                    /* test rows */
} RowErrors;

/* network: NULL: none, the mean in its place. ranged: each output in its range over the training rows, as in
   networks.csv. The paper does not define the accuracy of its gate (section 3: 90%): here all outputs of a right row
   are within 5% of their range. False with error set when memory is short. */
bool row_errors_find(RowErrors *errors, const Network *network, const Dataset *dataset, int outputs, bool ranged,
                     Error *error);

/* A training that fails if it is stopped, as results of half a training must not enter the study: as training_run, but
   NULL with error set if progress_report() stops it. */
Network *whole_training(const Dataset *dataset, const TrainingOptions *options, const Progress *progress, Error *error);
