/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of one launch. */
#pragma once
#include "dataset/dataset.h"

/* One touching pair in one step, or in one sweep of it. */
typedef struct PairRow {
    float inputs[PAIR_INPUTS_MAX], changes[PAIR_CHANGES], context[PAIR_CONTEXT];
    int32_t frame, bodies[2];
} PairRow;

/* The rows of one launch. */
typedef struct LaunchRows {
    PairRow *rows;
    size_t count, capacity;
    size_t start; /* index of its first row in the dataset */
} LaunchRows;

/* Runs a launched scene with the engine, and appends the rows for the dataset's view, target and labels. */
bool dataset_record_rows(const Dataset *dataset, const Scene *launched, LaunchRows *rows, Error *error);
