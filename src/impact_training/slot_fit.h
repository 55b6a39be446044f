/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fits a slot network to samples by mini-batch Adam; the rate decays to 0 by half a cosine. Quantisation-aware: loss
   and gradient are computed with the packed rows (network/packed_rows.h), the step changes the float rows, which are
   then packed again. Source: straight-through estimator, Bengio, Leonard, Courville, "Estimating or Propagating
   Gradients Through Stochastic Neurons for Conditional Computation" (2013), 4. */
#pragma once
#include "impact_training/slot_loss.h"

#include <stdint.h>

typedef struct SlotFit {
    double impulse_weight; /* of the impulse loss (slot_loss.h) */
    int impulse_epochs;    /* initial epochs with the impulse loss only */
    int epochs;            /* in total */
    double rate;           /* initial learning rate */
    bool learn_factors;    /* also fit the network's momentum factors */
    uint64_t seed;         /* of the sample order */
} SlotFit;

/* Changes the network's parameters and, if learn_factors, its factors. The samples have its inputs
   (slot_samples_compute_inputs). If progress stops the fit, keeps the current parameters. Same bits for any number of
   threads. False with error set: memory, or a NaN or infinite loss (the message names the epoch). */
bool slot_fit(SlotNetwork *network, const SlotSamples *samples, const SlotFit *fit, const Progress *progress,
              Error *error);

/* errors[count - first]: RMS velocity errors in m/s after the network and its sweeps, of the samples from index
   `first`. */
bool slot_errors(const SlotNetwork *network, const SlotSamples *samples, int first, double *errors, Error *error);
