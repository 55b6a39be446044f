/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network trained on pairs (learning/pair_training.h), ready to predict: its inputs, its outputs and what they
   mean. Then what pair-net and contact-net have in common. */
#pragma once
#include "base/base.h"
#include "base/settings.h"
#include "engine/engine.h"
#include "methods/pair.h"
#include "methods/sweeps.h"
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

/* The common part of pair-net and contact-net, which accept different networks. */

typedef struct PairSolver {
    PairNetwork network;
    int sweep_count;  /* for TARGET_IMPULSE */
    bool predicts;    /* false: the mean of its training data */
    int *pair_counts; /* [body_count] number of pairs of each body */
    size_t count_capacity;
} PairSolver;

#define PAIR_SOLVER_SWEEPS                                                                             \
    {                                                                                                  \
        "k", "sweeps over all pairs per step, for the target impulse (default: the scene's, else 10)", \
            SETTING_INT(PairSolver, sweep_count, 1, SWEEPS_MAX)                                        \
    }
#define PAIR_SOLVER_NET                                                                           \
    {                                                                                             \
        "net", "on|off: off predicts the mean of the training data for every pair (default: on)", \
            SETTING_BOOL(PairSolver, predicts)                                                    \
    }

/* Reads the network and the settings of the table. NULL with error set if one is refused. name: of the method. */
PairSolver *pair_solver_create(const char *name, const SettingSpec *known, const Settings *chosen, Error *error);
void pair_solver_destroy(void *state);

/* Solves the step with the network, as its target requires. */
bool pair_solver_solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error);
