/* SPDX-License-Identifier: GPL-3.0-or-later */
/* CMA-ES: minimises a function of some dozen numbers from its values alone. Source: Hansen, "The CMA Evolution
   Strategy: A Tutorial" (2016), with its default parameters, without negative weights. Own code on GSL's matrices and
   eigenvalues: of minimisers without derivatives GSL has the Nelder-Mead simplex only. */
#pragma once
#include "common/error.h"
#include "common/progress.h"

#include <stdint.h>

typedef struct CmaEs {
    int dimension; /* at least 1 */
    double step;   /* standard deviation of the first generation, along each axis */
    int generations;
    uint64_t seed;
    double (*cost)(void *context, const double *point); /* finite */
    void *context;
} CmaEs;

/* best: [dimension] the start; becomes the best point met, also when progress asks to stop early. False when memory is
   short. */
bool cma_es_minimize(const CmaEs *task, double *best, const Progress *progress, Error *error);
