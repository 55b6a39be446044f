/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loss: mean squared error over rows and outputs, normalised (paper, 4), its gradient, and its residuals.

   Rows are cut into chunks whose number depends on the network alone; each chunk is summed by one thread and
   the chunks in rising order: the same bits at any number of threads. */
#pragma once
#include "training/samples.h"

typedef struct Loss Loss;

/* Work space for networks of this shape, which must outlive it. */
Loss *loss_create(const Network *shape, Error *error);
void loss_destroy(Loss *loss);

double loss_value(Loss *loss, const Samples *samples, const double *parameters);

/* Also fills gradient[parameters]. */
double loss_gradient(Loss *loss, const Samples *samples, const double *parameters, double *gradient);

/* Prediction minus target: residuals[blocks, outputs, BLOCK_ROWS], 0 in the rows that fill up the last
   block. */
void loss_residuals(Loss *loss, const Samples *samples, const double *parameters, double *residuals);

/* Puts samples of block b into the block's inputs and runs it forward. */
void loss_forward(NetworkBlock *block, const Samples *samples, int64_t b, const double *parameters);
