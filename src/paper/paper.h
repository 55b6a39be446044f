/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The networks of the paper's study (Avatavului, Ifrim, Voncila 2023): a baseline, and others that differ from it in
   one factor each. The paper's own words for the baseline: ten inputs made of differences of positions (3.1), one
   hidden layer of ten, two outputs, sigmoids throughout, outputs scaled to [0, 1] (3.2), the sweep of launches (3.3).
   */
#pragma once
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "figures/sketch.h"
#include "learning/dataset.h"
#include "methods/pair.h"
#include "pictures/picture.h"
#include "runs/pieces.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Recorded launches of the single box and of the stack. DATA_PAPER has the paper's 201 places; the baseline has fewer,
   to keep the study short. */
typedef enum PaperData {
    DATA_SWEPT,
    DATA_RANDOM,
    DATA_MIXED,
    DATA_FINE,
    DATA_FINEST,
    DATA_PAPER,
    PAPER_DATA
} PaperData;

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

enum { PAPER_NETWORK_NAME_SIZE = 64 };

extern const PaperNetwork paper_networks[];
extern const int paper_network_count;

/* With all defaults set. */
PaperNetwork paper_network(int i);

enum { PAPER_FACTORS_SIZE = 256 };

/* In how many factors two networks with all defaults differ; names: "data layers ". The first width follows from the
   inputs, the last is the outputs'; the scaling belongs to the output's activation. */
int paper_network_factors(const PaperNetwork *a, const PaperNetwork *b, char names[PAPER_FACTORS_SIZE]);

/* The datasets of the paper's study, each recorded at its first use. */

enum { PAPER_SCENES = 4, PAPER_TRAINING_SCENES = 2, PAPER_PATH_SIZE = 4096, PAPER_DATASETS_MAX = 32 };

/* single, stack, pyramid, pyramid_settled, NULL; the first two are trained on. */
extern const char *const paper_scene_names[PAPER_SCENES + 1];

/* Launches of each scene. */
typedef struct PaperDataSize {
    const char *swept, *mixed, *fine, *finest, *paper, *transfer; /* m: "-5:5:0.05" */
    int random, mixed_random;                                     /* launches drawn at random, in addition */
    /* Only every so many rows of single impulses are kept: there are ten times as many as of others. */
    int impulse_every, finest_every;
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

/* The dataset of a network, owned by `datasets`. NULL with error set. */
const Dataset *paper_dataset(PaperDatasets *datasets, const PaperNetwork *network, Error *error);

/* The whole study of Avatavului, Ifrim, Voncila (2023), from seed to tables: networks trained in every reading of the
   paper, one factor at a time; their rates of right predictions; their runs in place of the solver; laws of physics in
   the loss; transfer learning; the systems that the paper cites. */

typedef struct PaperOptions {
    const char *scenes; /* folder of single.yaml, stack.yaml, pyramid.yaml, pyramid_settled.yaml */
    const char *folder; /* created if missing */
    bool quick;         /* fewer networks, launches, iterations */
    uint64_t seed;
    const PiecesRun *run; /* whole, a shard, or a merge */
    /* Draws what the tables show, and writes the report. */
    bool (*draw)(const struct PaperOptions *study, Error *error);
} PaperOptions;

/* Writes folder/table1.csv, networks.csv, rates.csv, closed_loop.csv, laws.csv, transfer.csv, system_scores.csv,
   study.csv and folder/networks/NAME.npz, then draws; a shard does its
   parts only, and of the files writes the networks that it trains. Finished parts are kept: the same study, by the same
   program, continues where it was interrupted. ERROR_INPUT for a scene that cannot be read, and for a merge of times of
   different processors; ERROR_INTERRUPTED if progress_report() stops it. *pieces tells what was done; it has no
   plan. */
bool paper_run(const PaperOptions *options, Pieces *pieces, const Progress *progress, Error *error);
