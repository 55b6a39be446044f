/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The interface of an optimiser and the table of them. Adding one is a file and a line. */
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
    const Laws *laws;                     /* NULL: none */
    int parameters;                       /* how many */
    double constant_test, constant_train; /* loss of predicting the mean */
    int iteration;                        /* of the last visit; -1 before the first */
    int scored;                           /* the last iteration whose score was reported */
    double loss_now, best_loss;           /* with what the laws add */
    double *now, *best;                   /* [parameters] of the last visit, and of the lowest train loss */
    bool finished;                        /* all iterations done, or asked to stop */
} Trainer;

typedef struct Optimizer {
    const char *name, *summary;
    /* Minimises the train loss from `parameters`, which it may overwrite: visits the start, then the result
       of every full-batch step, until the trainer is finished or there is no way on. */
    bool (*minimize)(Trainer *trainer, double *parameters, Error *error);
} Optimizer;

extern const Optimizer optimizer_adam, optimizer_bfgs, optimizer_gd, optimizer_lm;

/* Ends with NULL. */
extern const Optimizer *const optimizers[];

/* Takes the result of the next iteration (0: the start) and its train loss: keeps the best, reports the score
   and progress. False with error set where a number is not finite. */
bool trainer_visit(Trainer *trainer, const double *parameters, double train_loss, Error *error);
