/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network trained on pairs (learning/pair_training.h), ready to predict: its inputs, its outputs and what they
   mean. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/pair.h"
#include "nets/nets.h"

#include <stdbool.h>
#include <stddef.h>

/* Zero-initialise. */
typedef struct PairNetwork {
    Network *network;
    PairView view;
    PairTarget target;
    bool constant; /* predict the mean of the training data, whatever the inputs */
    /* Work space; grows and is reused: */
    float *scratch; /* of a prediction */
    float *numbers; /* inputs[inputs, pairs], then outputs[outputs, pairs], of the step's pairs */
    size_t capacity;
    PairMoment moment; /* needed by views by contact */
} PairNetwork;

/* Number of outputs per pair. */
static inline int pair_network_outputs(const PairNetwork *pair) { return pair->network->widths[pair->network->layers]; }

/* ERROR_INPUT, with the file, if it is not a network or its inputs, outputs and target do not fit each other; the
   message states what it has and what is needed. */
bool pair_network_read(PairNetwork *pair, const char *path, Error *error);
void pair_network_free(PairNetwork *pair);

/* outputs[outputs, pairs] for all pairs of the step, in their order, from the velocities before the warm start or, for
   views by contact, after it. Not for TARGET_IMPULSE. Valid until the next call. NULL: no memory. */
const float *pair_network_predict(PairNetwork *pair, const ContactProblem *problem, int *pairs);

/* outputs[outputs] for the pair whose contacts begin at `first`, at any moment of the step (pair_inputs). */
void pair_network_predict_one(PairNetwork *pair, const ContactProblem *problem, const PairMoment *now, int first,
                              float *outputs);
