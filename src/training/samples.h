/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Dataset rows prepared for training: normalised inputs and targets, in the block layout of network_gradient.h. */
#pragma once
#include "dataset/dataset.h"
#include "network/network_gradient.h"

typedef struct Samples {
    int64_t rows, blocks; /* the last block is padded with zeros */
    int inputs, outputs;
    float *x; /* [blocks, inputs, BLOCK_ROWS], normalised */
    float *y; /* [blocks, outputs, BLOCK_ROWS], normalised */
} Samples;

static inline int samples_in_block(const Samples *samples, int64_t b) {
    int64_t left = samples->rows - b * BLOCK_ROWS;
    return left < BLOCK_ROWS ? (int)left : BLOCK_ROWS;
}

/* Scales to minimum 0 and maximum 1 (paper, 3.2), or to mean 0 and standard deviation 1 (3.1). */
typedef enum OutputScale { SCALE_MINMAX, SCALE_STANDARD } OutputScale;

/* Sets the network's input and output normalisation and output_mean from the training rows. Inputs are standardised. A
   constant column has scale 1. */
void samples_fit_normalisation(const Dataset *dataset, OutputScale scale, Network *network);

/* The training rows or, if test, the test rows. Targets for two outputs: change of b's velocity relative to a (x, y);
   for six: pair_changes(). */
Samples *samples_create(const Dataset *dataset, const Network *network, bool test, Error *error);
void samples_destroy(Samples *samples);

/* mean[outputs] of y */
void samples_mean(const Samples *samples, double *mean);
