/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fits the network of interior-net to recorded problems by Adam, through the iterations (unrolled_interior.h). Source:
   Kingma, Ba, "Adam: A Method for Stochastic Optimization" (2015). */
#pragma once
#include "impact_training/impact_problems.h"
#include "interior_training/net_state.h"
#include "interior_training/unrolled_interior.h"

/* Percentiles and means of the error over problems, m/s, after each iteration. */
typedef struct NetErrors {
    double mean[UNROLLED_ITERATIONS_MAX], percentile95[UNROLLED_ITERATIONS_MAX];
} NetErrors;

/* Work space; zero-initialise. */
typedef struct NetFit {
    UnrolledInterior *unrolled; /* [threads] */
    int threads;
    double *slopes, *losses; /* [batch, weights], [batch] */
    int *order;              /* [problems] */
    size_t order_capacity;
} NetFit;

bool net_fit_begin(NetFit *fit, Error *error);
void net_fit_free(NetFit *fit);

/* One epoch of minibatches in an order that depends on `seed`. rate: of its first step; it falls to `last_rate`.
   *mean_loss: of the problems. Same bits for any number of threads. */
bool net_fit_epoch(NetFit *fit, NetState *state, const ImpactProblems *problems, uint64_t seed, double rate,
                   double last_rate, double *mean_loss, Error *error);

/* Errors with these weights. */
bool net_fit_errors(NetFit *fit, const double *weights, const ImpactProblems *problems, NetErrors *errors,
                    Error *error);
