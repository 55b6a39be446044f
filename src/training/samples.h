/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of a dataset as training sees them: targets chosen, numbers normalised, in blocks of the
   gradient's layout. */
#pragma once
#include "dataset/dataset.h"
#include "network/network_gradient.h"

typedef struct Samples {
    int64_t rows, blocks; /* the last block is filled up with zeros */
    int inputs, outputs;
    float *x; /* [blocks, inputs, BLOCK_ROWS], normalised */
    float *y; /* [blocks, outputs, BLOCK_ROWS], normalised */
} Samples;

/* Numbers of samples that block b holds. */
static inline int samples_in_block(const Samples *samples, int64_t b) {
    int64_t left = samples->rows - b * BLOCK_ROWS;
    return left < BLOCK_ROWS ? (int)left : BLOCK_ROWS;
}

/* Minimum and maximum to 0 and 1 (paper, 3.2), or mean 0 and standard deviation 1 (3.1). */
typedef enum OutputScale { SCALE_MINMAX, SCALE_STANDARD } OutputScale;

/* Sets the network's normalisations and the mean of its outputs from the rows to train on; inputs to mean 0 and
   standard deviation 1. A column that never changes has scale 1. */
void samples_fit_normalisation(const Dataset *dataset, OutputScale scale, Network *network);

/* The rows to train on, or those held out for the test. Two outputs: change of the velocity of b relative to
   a (x, y); six: pair_changes(). */
Samples *samples_create(const Dataset *dataset, const Network *network, bool test, Error *error);
void samples_destroy(Samples *samples);

/* mean[outputs] of y */
void samples_mean(const Samples *samples, double *mean);
