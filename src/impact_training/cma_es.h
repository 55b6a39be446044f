/* SPDX-License-Identifier: GPL-3.0-or-later */
/* CMA-ES: derivative-free minimisation of a function of up to some dozens of variables. Source: Hansen, "The CMA
   Evolution Strategy: A Tutorial" (2016), with its default parameters, without negative weights. Own code on
   GSL's matrices and eigenvalues: of derivative-free minimisers GSL has the Nelder-Mead simplex only. */
#pragma once
#include "common/error.h"
#include "common/progress.h"

#include <stdint.h>

typedef struct CmaEs {
    int dimension; /* at least 1 */
    double step;   /* initial standard deviation along each axis */
    int generations;
    uint64_t seed;
    double (*cost)(void *context, const double *point); /* must return a finite value */
    void *context;
} CmaEs;

/* best[dimension]: the start point on entry, the best point evaluated on return, also if progress stops the search.
   False if out of memory. */
bool cma_es_minimize(const CmaEs *task, double *best, const Progress *progress, Error *error);
