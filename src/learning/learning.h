/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What trainings share: Adam. Each weight steps by its mean slope, divided by the root of its mean squared slope. Same
   bits on every machine. Source: Kingma, Ba, "Adam: A Method for Stochastic Optimization" (2015).

       Adam adam;
       bool ok = adam_create(&adam, count, error);
       adam_step(&adam, slopes, rate); ... adam_free(&adam); */
#pragma once
#include "base/base.h"

#include <math.h>
#include <stdint.h>

/* Zero-initialise what is freed without being created. */
typedef struct Adam {
    int64_t count;                   /* of weights */
    double *weights, *mean, *square; /* [count] the moments are those of the slopes */
    int64_t steps;                   /* so far */
    double mean_left, square_left;   /* decay to the power `steps`: what the moments lack at the start */
} Adam;

/* What the weights share in a step. */
typedef struct AdamStep {
    double rate, over_mean, over_square; /* over: the bias corrections */
} AdamStep;

/* All weights and moments 0. */
bool adam_create(Adam *adam, int64_t count, Error *error);
void adam_free(Adam *adam);

/* Over arrays [count] of the caller, with moments 0; not to be freed. */
Adam adam_over(double *weights, double *mean, double *square, int64_t count);

/* Forgets steps and moments, and keeps the weights. */
void adam_restart(Adam *adam);

#define ADAM_DECAY 0.9 /* Kingma and Ba, as the others */
#define ADAM_SQUARE_DECAY 0.999

/* Counts a step whose loop is the caller's. */
AdamStep adam_next(Adam *adam, double rate);

/* Updates the moments of one weight; returns what to subtract from the weight. */
static inline double adam_change(const AdamStep *step, double slope, double *mean, double *square) {
    const double epsilon = 1e-8;
    *mean = ADAM_DECAY * *mean + (1 - ADAM_DECAY) * slope;
    *square = ADAM_SQUARE_DECAY * *square + (1 - ADAM_SQUARE_DECAY) * slope * slope;
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
