/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Adam: each weight steps by its mean slope, divided by the root of its mean squared slope. Same bits on every machine.
   Source: Kingma, Ba, "Adam: A Method for Stochastic Optimization" (2015). */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

#define ADAM_SQUARE_DECAY 0.999 /* Kingma and Ba */

typedef struct Adam {
    int64_t count;                   /* of weights */
    double *weights, *mean, *square; /* [count] the moments are those of the slopes */
    int64_t steps;                   /* so far */
    double square_decay;
    double mean_left, square_left; /* decay to the power `steps`: what the moments lack at the start */
} Adam;

/* All weights and moments 0. */
bool adam_create(Adam *adam, int64_t count, double square_decay, Error *error);
void adam_free(Adam *adam);

/* Over arrays [count] of the caller, after `steps` steps; not to be freed. */
Adam adam_over(double *weights, double *mean, double *square, int64_t count, int64_t steps, double square_decay);

/* Forgets the moments, and keeps the weights. */
void adam_restart(Adam *adam);

/* One step; slopes[count] are d loss / d weights. */
void adam_step(Adam *adam, const double *slopes, double rate);
