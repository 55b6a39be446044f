/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The arrays of a dataset file, for its writers. */
#pragma once
#include "dataset/dataset.h"
#include "npz/npz.h"

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
    char scenes[DATASET_SCENES_SIZE];
} DatasetArrays;

/* The arrays in the order of the file; they point to the dataset and to *arrays. Of a dataset without rows, the arrays of
   rows have no data: rows can be appended (npz/npz_stream.h). Returns their number, which is one less without context. */
int dataset_arrays(const Dataset *dataset, bool context, DatasetArrays *arrays);
