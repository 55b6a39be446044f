/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The common part of pair-net, contact-net and constant, which accept different networks. */
#pragma once
#include "common/settings.h"
#include "solvers/pair_network.h"

typedef struct PairSolver {
    PairNetwork network;
    int sweep_count;  /* for TARGET_IMPULSE */
    int *pair_counts; /* [body_count] number of pairs of each body */
    size_t count_capacity;
} PairSolver;

#define PAIR_SOLVER_NET \
    { "net", "on|off: off predicts the mean of the training data for every pair (default: on)" }

/* Reads the settings network, k (default: 10) and net. NULL with error set if one is refused. name: of the method. */
PairSolver *pair_solver_create(const char *name, const Settings *chosen, Error *error);
void pair_solver_destroy(void *state);

/* Solves the step with the network, as its target requires: pair_net.c and contact_net.c. */
bool pair_solver_solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error);
