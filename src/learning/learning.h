/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all trainings share: Adam and the state of a training on disk. */
#pragma once
#include "base/base.h"

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

/* The state of a training on disk: the same command continues an interrupted training, with the same result. What follows
   from command and weights, such as recorded launches, is not stored. */

enum { FIT_COMMAND_SIZE = 512 };

typedef struct FitState {
    const char *command;  /* of the training, at most FIT_COMMAND_SIZE - 1 bytes; another one does not continue it */
    int32_t stage, epoch; /* to do next; the training says what they count, from 0 */
    Adam adam;
} FitState;

/* Writes the state, atomically. */
bool fit_state_write(const FitState *state, const char *path, Error *error);

/* Reads the state; `command` and adam.count must be set. *found: whether there is one of this command; if not, the state is
   not changed. ERROR_INPUT, with the file, if it is damaged or of another number of weights: the user can delete it. */
bool fit_state_read(FitState *state, const char *path, bool *found, Error *error);
