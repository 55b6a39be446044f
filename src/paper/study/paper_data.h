/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The datasets of the paper's study, each recorded at its first use. */
#pragma once
#include "paper/study/paper_networks.h"

enum { PAPER_SCENES = 4, PAPER_TRAINING_SCENES = 2, PAPER_PATH_SIZE = 4096, PAPER_DATASETS_MAX = 32 };

/* single, stack, pyramid, pyramid_settled, NULL; the first two are trained on. */
extern const char *const paper_scene_names[PAPER_SCENES + 1];

/* Launches of each scene. */
typedef struct PaperDataSize {
    const char *swept, *mixed, *fine, *finest, *paper; /* m: "-5:5:0.05" */
    int random, mixed_random;                          /* launches drawn at random, in addition */
    /* Only every so many rows of single impulses are kept: there are ten times as many as of others. */
    int impulse_every, finest_every;
} PaperDataSize;

typedef struct StoredDataset {
    PaperData data;
    DatasetLabels labels;
    PairView view;
    PairTarget target;
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

/* Launches of one scene, with the target pair. The caller destroys it. */
Dataset *paper_scene_dataset(const PaperDatasets *datasets, int scene, const char *bomb_x, Error *error);

/* The same for the sweep of both training scenes, with the pairs' context (dataset.h). */
Dataset *paper_context_dataset(const PaperDatasets *datasets, Error *error);

/* The dataset of a network, owned by `datasets`. NULL with error set. */
const Dataset *paper_dataset(PaperDatasets *datasets, const PaperNetwork *network, Error *error);
