/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The optimiser interface and the table of optimisers. A new one is one file and one line. */
#pragma once
#include "training/loss.h"
#include "training/training.h"

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
    bool finished;                        /* all iterations done, or cancelled by progress */
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
