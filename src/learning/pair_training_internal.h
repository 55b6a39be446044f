/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of the training of pair networks. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "learning/dataset.h"
#include "learning/pair_training.h"
#include "nets/nets.h"

/* Dataset rows prepared for training: normalised inputs and targets, in the layout of NetworkBlock. */

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

/* Gauss-Newton products J^T J and J^T u of the Jacobian J [rows * outputs, parameters] of the predictions. Summed block
   by block; J is never stored. */

typedef struct GaussNewton GaussNewton;

/* Work space for networks of this shape; `shape` must outlive it. */
GaussNewton *gauss_newton_create(const Network *shape, Error *error);
void gauss_newton_destroy(GaussNewton *work);

/* u[blocks, outputs, BLOCK_ROWS]: the layout of loss_residuals(), 0 in padding rows. Fills jtu[parameters] and, if jtj
   != NULL, the lower triangle of jtj[parameters, parameters]. Same bits for any number of threads. */
void gauss_newton_sum(GaussNewton *work, const Samples *samples, const double *parameters, const double *u, double *jtu,
                      double *jtj);

/* The training loss of normalised outputs (mean over rows and outputs), its gradient and its residuals. With d =
   prediction - target:

       mse        d^2 (paper, 4)
       smooth-l1  d^2 if |d| <= t, else t (2 |d| - t): linear beyond t, so rare large impacts do not dominate. t is
                  SMOOTH_L1_THRESHOLD in the units of the data, normalised for each output. Huber, "Robust Estimation of
                  a Location Parameter" (1964).

   Same bits for any number of threads: the number of chunks of rows depends only on the network, one thread sums each
   chunk, and the chunks are added in order. */

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

/* The optimiser interface and the table of optimisers (optimizers.c). A new one is one function and one line. */

/* One training in progress. */
typedef struct Trainer {
    const TrainingOptions *options;
    const Progress *progress;
    const Network *network; /* shape and normalisation */
    const Samples *train, *test;
    LossKind loss_kind;
    Loss *loss;
    const Laws *laws;                     /* or NULL */
    int parameters;                       /* number of parameters */
    double constant_test, constant_train; /* loss of the constant predictor (training mean) */
    int iteration;                        /* of the last trainer_visit(); -1 before the first */
    int scored;                           /* the last iteration whose score was reported */
    double loss_now, best_loss;           /* including the laws' terms */
    double *now, *best;                   /* [parameters] of the last visit and of the lowest train loss */
    double held_best;                     /* the lowest held-out loss that was asked for, and when */
    int held_at;
    bool finished; /* all iterations done, cancelled by progress, or out of patience */
} Trainer;

typedef struct Optimizer {
    const char *name, *summary;
    /* Minimises the train loss, starting from `parameters`, which it may overwrite. Calls trainer_visit() for the start
       and after every full-batch step, until the trainer is finished or no step lowers the loss. */
    bool (*minimize)(Trainer *trainer, double *parameters, Error *error);
} Optimizer;

extern const Optimizer optimizer_adam, optimizer_bfgs, optimizer_gd, optimizer_lm;

/* Ends with NULL. */
extern const Optimizer *const optimizers[];

/* Records the parameters and train loss of the next iteration (0: the start): keeps the best, reports score and
   progress. False with error set if a parameter or the loss is NaN or infinite. */
bool trainer_visit(Trainer *trainer, const double *parameters, double train_loss, Error *error);

/* Validates training options against a dataset. */

/* ERROR_INPUT: layer widths, laws or a start network that do not match the dataset; no training rows or no test
   rows. */
bool training_check(const Dataset *dataset, const TrainingOptions *options, Error *error);

/* The option words of TrainingOptions: activations, output scaling and loss. */

typedef struct NetworkConfig {
    Activation hidden, output;
    OutputScale scale;
} NetworkConfig;

/* ERROR_INPUT if an option contradicts the start network. */
bool network_config_matches(const Network *start, const TrainingOptions *options, Error *error);
