/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Losses and gradients of batches of examples, on all threads. */
#pragma once
#include "particles_training/gns_backward.h"
#include "particles_training/gns_examples.h"

/* Of one thread. */
typedef struct GnsWorker {
    GnsExample example;
    GnsPass pass;
    GnsBackward back;
    float *slopes; /* [particles, GNS_OUTPUTS] of the loss */
    size_t slope_capacity;
} GnsWorker;

typedef struct GnsFit {
    const GnsExamples *examples;
    GnsNet *net; /* its parameters are those of the pass */
    int batch, threads;
    GnsWorker *workers;    /* [threads] */
    float *transposed;     /* [parameters] */
    float *gradients;      /* [batch, parameters] */
    double *losses;        /* [batch] */
    double *mean_gradient; /* [parameters] of the batch */
} GnsFit;

/* False when memory is short; free it in any case. */
bool gns_fit_begin(GnsFit *fit, const GnsExamples *examples, GnsNet *net, int batch, Error *error);
void gns_fit_free(GnsFit *fit);

/* The mean loss of examples first to first + batch - 1, and its gradient; the same bits for any number of threads. */
bool gns_fit_batch(GnsFit *fit, uint64_t first, double *loss, Error *error);

/* The same without a gradient. */
bool gns_fit_loss(GnsFit *fit, const GnsExamples *examples, uint64_t first, double *loss, Error *error);

/* The loss of the example in the worker, whose pass has run: the mean over particles that count of the squared error, in units
   of the net's acceleration. Fills worker->slopes. */
double gns_example_loss(GnsWorker *worker, const GnsScales *scales);
