/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fits a slot network to samples: Adam on batches drawn in random order, its rate falling to 0 by half a cosine. Loss and
   gradient are those of the packed network (network/packed_rows.h), the steps those of its float rows, which are packed
   anew after each. Source: straight-through estimation, Bengio, Leonard, Courville, "Estimating or Propagating Gradients
   Through Stochastic Neurons for Conditional Computation" (2013), 4. */
#pragma once
#include "impact_training/slot_loss.h"

#include <stdint.h>

typedef struct SlotFit {
    double near;        /* weight of the impulses' own loss (slot_loss.h) */
    int near_epochs;    /* at first only that */
    int epochs;         /* over all samples, the first ones included */
    double rate;        /* of the first step */
    bool learn_factors; /* the network's factors of momentum, too */
    uint64_t seed;      /* of the order */
} SlotFit;

/* Changes the network's parameters and, if asked to, its factors. The samples have been shown to it. Stops early, with
   what it has, where progress asks to. The same bits at any number of threads. False with error set: memory, or a loss
   that left the finite numbers (with the epoch). */
bool slot_fit(SlotNetwork *network, const SlotSamples *samples, const SlotFit *fit, const Progress *progress,
              Error *error);

/* errors[count]: m/s, the RMS velocity error of the samples from `first` on after the network and its sweeps. */
bool slot_errors(const SlotNetwork *network, const SlotSamples *samples, int first, double *errors, Error *error);
