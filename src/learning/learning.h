/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What trainings share: Adam, and a training's state on disk, progress and interruption.

       Fit fit;
       fit_init(&fit, command, "net.npz.part", progress);
       bool found, ok = fit_begin(&fit, weights, &found, error) && (found || fit_write(&fit, error)) &&
                        fit_run(&fit, 0, weights, &steps, &loss, error); ... fit_free(&fit); */
#pragma once
#include "base/base.h"
#include "base/machine.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>

/* Adam: each weight steps by its mean slope, divided by the root of its mean squared slope. Same bits on every machine.
   Source: Kingma, Ba, "Adam: A Method for Stochastic Optimization" (2015). */

#define ADAM_DECAY 0.9 /* Kingma and Ba, as the others */
#define ADAM_SQUARE_DECAY 0.999

typedef struct Adam {
    int64_t count;                   /* of weights */
    double *weights, *mean, *square; /* [count] the moments are those of the slopes */
    int64_t steps;                   /* so far */
    double square_decay;
    double mean_left, square_left; /* decay to the power `steps`: what the moments lack at the start */
} Adam;

/* What the weights share in a step. */
typedef struct AdamStep {
    double rate, over_mean, over_square, square_decay; /* over: the bias corrections */
} AdamStep;

/* All weights and moments 0. */
bool adam_create(Adam *adam, int64_t count, double square_decay, Error *error);
void adam_free(Adam *adam);

/* Over arrays [count] of the caller, after `steps` steps; not to be freed. */
Adam adam_over(double *weights, double *mean, double *square, int64_t count, int64_t steps, double square_decay);

/* Forgets the moments, and keeps the weights. */
void adam_restart(Adam *adam);

/* Counts a step whose loop is the caller's. */
AdamStep adam_next(Adam *adam, double rate);

/* Updates the moments of one weight; returns what to subtract from the weight. */
static inline double adam_change(const AdamStep *step, double slope, double *mean, double *square) {
    const double epsilon = 1e-8;
    *mean = ADAM_DECAY * *mean + (1 - ADAM_DECAY) * slope;
    *square = step->square_decay * *square + (1 - step->square_decay) * slope * slope;
    return step->rate * *mean * step->over_mean / (sqrt(*square * step->over_square) + epsilon);
}

/* The share of the first rate after this share of the steps: half a cosine from 1 to 0 (Loshchilov, Hutter, "SGDR",
   2017). Rounded to float, so that the bits do not depend on the maths library. */
double adam_cosine(double done);

/* One step; slopes[count] are d loss / d weights. */
void adam_step(Adam *adam, const double *slopes, double rate);

/* Shortens slopes that are longer than `most`: one strange batch must not throw the weights far. False, and all are 0,
   if one is NaN or infinite. */
bool slopes_limit(double *slopes, int64_t count, double most);

/* A training that survives an interruption: the same command continues from its state on disk, with the same result.
   What follows from command and weights, such as recorded launches, is not stored. */

enum { FIT_COMMAND_SIZE = 512 };

typedef struct Fit {
    const char *command;  /* of the training, at most FIT_COMMAND_SIZE - 1 bytes; another one does not continue it */
    const char *path;     /* of the state */
    int32_t stage, epoch; /* of the training, from 0; how often the stage was written */
    Adam adam;            /* of all weights; its steps are those of the stage */
    ProgressStage share;  /* of the progress: that of the present work */
    Progress progress;    /* of that work */
} Fit;

/* Nothing is read yet; the share of the progress is 0 until progress_next_stage(). The fit stays where it is. */
void fit_init(Fit *fit, const char *command, const char *path, const Progress *progress);

/* Weights 0. Continues with the state of the command if there is one: *found. ERROR_INPUT, with the file, if it is
   damaged or of another number of weights: the user can delete it. Free it in any case. */
bool fit_begin(Fit *fit, int64_t weights, bool *found, Error *error);
void fit_free(Fit *fit);

/* Writes the state, atomically. A training writes it before any work: an output folder that cannot be written to is
   refused. */
bool fit_write(const Fit *fit, Error *error);

/* Begins a stage: no steps, and no moments, as its loss is another. */
void fit_stage(Fit *fit, int stage);

/* The steps of a stage. */
typedef struct FitSteps {
    int64_t count, written; /* in all; from one state on disk to the next */
    bool (*step)(void *context, Adam *adam, double *loss, Error *error);
    bool (*on_written)(void *context, double loss, int64_t steps, Error *error); /* sum and number of losses; or NULL */
    void *context;
} FitSteps;

/* Does what is left of the steps, on weights [at, at + count) of the fit. *loss: the sum since the last state but one,
   0 without a step. ERROR_INTERRUPTED if progress requests a stop: the state stays. */
bool fit_run(Fit *fit, int64_t at, int64_t count, const FitSteps *steps, double *loss, Error *error);
