/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Datasets: launches that are run and recorded, rows of touching pairs, subsets, files. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "base/npz.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/pair.h"
#include "nets/nets.h"
#include "scenes/scenes.h"

#include <stddef.h>
#include <stdint.h>

/* The paper's data (Avatavului, Ifrim, Voncila 2023, section 3.1): inputs and changes by the solver, for touching pairs
   of bodies. A row is a pair in a step, or for TARGET_IMPULSE a pair in one sweep of a step. */

enum { DATASET_VERSION = 3, DATASET_MAX_SCENES = 16, DATASET_NAME_SIZE = 128, DATASET_MAX_LAUNCHES = 100000 };

/* The source of the changes: the engine's solution, or the converged solution of the same contact problem
   (methods/reference.h), the paper's more accurate source. Steps that do not converge have no rows. */
typedef enum DatasetLabels { DATASET_BY_ENGINE, DATASET_BY_REFERENCE, DATASET_LABELS } DatasetLabels;

extern const char *const dataset_label_names[DATASET_LABELS + 1]; /* ends with NULL */

typedef struct Dataset {
    PairView view;
    PairTarget target;
    DatasetLabels labels;
    int64_t rows;
    float *inputs;   /* [rows, pair_views[view].count]: pair_inputs() */
    float *changes;  /* [rows, pair_change_count(target)]: pair_step_changes() */
    float *context;  /* [rows, PAIR_CONTEXT]: pair_context(), for laws in the loss; NULL if not recorded */
    int32_t *launch; /* [rows] launch of the row */
    int32_t *frame;  /* [rows] number of the step */
    int32_t *bodies; /* [rows, 2] */
    int launches;
    int32_t *launch_scene;                           /* [launches] index into scenes */
    float *launch_x, *launch_rotation, *launch_spin; /* [launches] of the bomb; m, rad, rad/s */
    uint8_t *launch_test; /* [launches] 1: held out for the test score (80/20, drawn with the seed) */
    int scene_count;
    char scenes[DATASET_MAX_SCENES][DATASET_NAME_SIZE];
    void *row_block, *launch_block; /* the arrays of rows, and of launches */
    int64_t unconverged; /* steps without rows, as the reference did not converge; of a recording, not in files */
} Dataset;

/* Number of inputs. */
static inline int dataset_inputs(const Dataset *dataset) { return pair_views[dataset->view].count; }

/* True if the row's launch is held out. */
static inline bool dataset_is_test(const Dataset *dataset, int64_t row) {
    return dataset->launch_test[dataset->launch[row]] != 0;
}

/* What an output is trained to predict: one of all changes, or, of two outputs, the change of b's velocity relative to
   a's. */
static inline float dataset_target(const Dataset *dataset, int64_t row, int outputs, int k) {
    const int count = pair_change_count(dataset->target);
    const float *changes = dataset->changes + row * count;
    return outputs == count ? changes[k] : changes[k + 3] - changes[k];
}

typedef struct DatasetOptions {
    const char *const *scenes; /* paths of scene files */
    int scene_count;
    /* Launches of each scene. None of the three: 201 of its family. */
    const LaunchTable *table; /* with neither of the others; NULL: none */
    const char *table_path;   /* its file */
    FloatRange bomb_x;        /* m: swept, with the scene's rotation and spin; count may be 0 */
    int random;               /* random: x in +-15 m, rotation +-1.5 rad, spin +-20 rad/s (3.3) */
    PairView view;
    PairTarget target;
    DatasetLabels labels;
    /* Keep every n-th row of a launch; 0 or 1: all. From row (launch mod n) on: with the first of each launch, which is
       its first blow, blows would be too many. */
    int every;
    bool context;  /* record the context; for TARGET_PAIR */
    uint64_t seed; /* of the random launches and of the 80/20 split by launch */
} DatasetOptions;

/* Runs every launch of every scene with the engine and records it. The result does not depend on the number of threads.
   ERROR_INPUT if a scene cannot be read, has no bomb or needs a family and has none, the launches vary in mass or
   frame, there are fewer than 5 launches per scene (one must be held out), the target has no such labels, or progress
   requests a stop. */
Dataset *dataset_record(const DatasetOptions *options, const Progress *progress, Error *error);
void dataset_destroy(Dataset *dataset);

/* Another split of the same launches: test[launches] as launch_test of a recording with this seed. False with error set
   when memory is short. */
bool dataset_split(const Dataset *dataset, uint64_t seed, uint8_t *test, Error *error);

/* Arrays for so many launches, zero, and for so many rows, not zeroed; view and target are set. False when memory is
   short. */
bool dataset_make_launches(Dataset *dataset, int launches);
bool dataset_make_rows(Dataset *dataset, int64_t rows, bool context);

bool dataset_write(const Dataset *dataset, const char *path, Error *error);
Dataset *dataset_read(const char *path, Error *error);

/* Subsets of the training launches, with the same held-out launches. */

/* A copy with the rows of all held-out launches and of the training launches for which keep[launches] is true. Launches
   keep their numbers: those left out remain listed without rows. ERROR_INPUT if no training rows remain. */
Dataset *dataset_subset(const Dataset *dataset, const bool *keep, Error *error);

/* The same with `count` training launches drawn from those with rows. With the same seed, a larger subset contains a
   smaller one. ERROR_INPUT if there are not enough. */
Dataset *dataset_draw_subset(const Dataset *dataset, int count, uint64_t seed, Error *error);

/* The arrays of a dataset file, for its writers. */

/* Words and the tables of launches come first, then the arrays of rows. */
enum {
    DATASET_WORDS = 6,
    DATASET_ROW_ARRAYS = 6,
    DATASET_FIRST_ROWS = DATASET_WORDS + 5,
    DATASET_ARRAYS = DATASET_FIRST_ROWS + DATASET_ROW_ARRAYS,
    DATASET_SCENES_SIZE = DATASET_MAX_SCENES * DATASET_NAME_SIZE
};

typedef struct DatasetArrays {
    NpzArray list[DATASET_ARRAYS]; /* the last is the context */
    NetField fields[NET_FIELDS_MAX];
    char scenes[DATASET_SCENES_SIZE];
} DatasetArrays;

/* The arrays in the order of the file; they point to the dataset and to *arrays. Returns their number, which is one
   less without context. */
int dataset_arrays(const Dataset *dataset, DatasetArrays *arrays);
