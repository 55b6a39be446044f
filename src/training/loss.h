/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The training loss of normalised outputs (mean over rows and outputs), its gradient and its residuals. With d =
   prediction - target:

       mse        d^2 (paper, 4)
       smooth-l1  d^2 if |d| <= t, else t (2 |d| - t): linear beyond t, so rare large impacts do not dominate. t is
                  SMOOTH_L1_THRESHOLD in the units of the data, normalised for each output. Huber, "Robust Estimation of
                  a Location Parameter" (1964).

   Same bits for any number of threads: the number of chunks of rows depends only on the network, one thread sums each
   chunk, and the chunks are added in order. */
#pragma once
#include "training/laws.h"
#include "training/samples.h"

typedef enum LossKind { LOSS_MSE, LOSS_SMOOTH_L1 } LossKind;

#define SMOOTH_L1_THRESHOLD 0.3 /* m/s and rad/s */

typedef struct Loss Loss;

/* Work space for networks of this shape and output normalisation; the network must outlive it. */
Loss *loss_create(const Network *shape, LossKind kind, Error *error);
void loss_destroy(Loss *loss);

/* laws: adds their terms; the samples must then be the training rows. May be NULL. */
double loss_value(Loss *loss, const Samples *samples, const Laws *laws, const double *parameters);

/* Also fills gradient[parameters]. */
double loss_gradient(Loss *loss, const Samples *samples, const Laws *laws, const double *parameters, double *gradient);

/* The loss of predicting constant[outputs] for every row. */
double loss_of_constant(const Loss *loss, const Samples *samples, const double *constant);

/* For mse only: residuals[blocks, outputs, BLOCK_ROWS] = prediction - target, 0 in the padding rows of the last
   block. */
void loss_residuals(Loss *loss, const Samples *samples, const double *parameters, double *residuals);

/* Forward pass on block b of the samples. */
void loss_forward(NetworkBlock *block, const Samples *samples, int64_t b, const double *parameters);
