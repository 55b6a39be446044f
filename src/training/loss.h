/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loss of normalised outputs, mean over rows and outputs, its gradient, and its residuals. With d the distance of
   an output from its target:

       mse        d^2 (paper, 4)
       smooth-l1  d^2 where |d| <= t, beyond it t (2 |d| - t): the slope stays that of the threshold t, which is
                  SMOOTH_L1_THRESHOLD in the units of the data, and so another number for each output. Rare large
                  impacts do not outweigh all the rest. Huber, "Robust Estimation of a Location Parameter" (1964).

   Rows are cut into chunks whose number depends on the network alone; each chunk is summed by one thread and
   the chunks in rising order: the same bits at any number of threads. */
#pragma once
#include "training/laws.h"
#include "training/samples.h"

typedef enum LossKind { LOSS_MSE, LOSS_SMOOTH_L1 } LossKind;

#define SMOOTH_L1_THRESHOLD 0.3 /* m/s and rad/s */

typedef struct Loss Loss;

/* Work space for networks of this shape and output normalisation; the network must outlive it. */
Loss *loss_create(const Network *shape, LossKind kind, Error *error);
void loss_destroy(Loss *loss);

/* laws: what they add too, where the samples are the rows to train on; or NULL. */
double loss_value(Loss *loss, const Samples *samples, const Laws *laws, const double *parameters);

/* Also fills gradient[parameters]. */
double loss_gradient(Loss *loss, const Samples *samples, const Laws *laws, const double *parameters, double *gradient);

/* That of predicting constant[outputs] for every row. */
double loss_of_constant(const Loss *loss, const Samples *samples, const double *constant);

/* Of mse only: prediction minus target: residuals[blocks, outputs, BLOCK_ROWS], 0 in the rows that fill up the last
   block. */
void loss_residuals(Loss *loss, const Samples *samples, const double *parameters, double *residuals);

/* Puts samples of block b into the block's inputs and runs it forward. */
void loss_forward(NetworkBlock *block, const Samples *samples, int64_t b, const double *parameters);
