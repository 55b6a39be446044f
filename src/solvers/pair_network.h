/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network trained on pairs (training/training.h), ready to be asked: what it sees, what it says, and about what. */
#pragma once
#include "network/network.h"
#include "pair/pair.h"

#include <stdbool.h>
#include <stddef.h>

/* Zero-initialise. */
typedef struct PairNetwork {
    Network *network;
    PairView view;
    PairTarget target;
    bool constant; /* say the mean of the training data, whatever there is to see */
    /* Work space; grows and is reused, so that a step allocates nothing: */
    float *scratch; /* of a prediction */
    float *numbers; /* inputs[.., pairs], then outputs[.., pairs], of the step's pairs */
    size_t capacity;
    PairMoment moment; /* that the view asks for */
} PairNetwork;

/* Numbers that it says of a pair. */
static inline int pair_network_outputs(const PairNetwork *pair) { return pair->network->widths[pair->network->layers]; }

/* ERROR_INPUT, naming the file, where it holds no network or its inputs, outputs and target do not fit each other: then
   with what it holds and what is needed. */
bool pair_network_read(PairNetwork *pair, const char *path, Error *error);
void pair_network_free(PairNetwork *pair);

/* outputs[.., pairs] for all pairs of the step, in their order, all seen in the same moment: before the warm start, or
   where the view is by contact after it. For any target but TARGET_IMPULSE. The numbers last until the next call. NULL:
   no memory. */
const float *pair_network_predict(PairNetwork *pair, const ContactProblem *problem, int *pairs);

/* outputs[..] for the pair whose contacts begin at `first`, at any moment (pair_inputs). */
void pair_network_predict_one(PairNetwork *pair, const ContactProblem *problem, const PairMoment *now, int first,
                              float *outputs);

/* What its outputs (one number every `stride`) mean for the two bodies, in world axes: change of velocity (2) and
   angular velocity (1) of a, then of b. Six outputs are these changes. Two are the change of the relative velocity,
   here by the impulse that makes it, acting at the middle of the contact points. Not for TARGET_POINTS. */
void pair_network_changes(const PairNetwork *pair, const ContactProblem *problem, int first, const float *outputs,
                          int stride, float changes[PAIR_CHANGES]);
