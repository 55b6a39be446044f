/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the solvers that ask a pair network share: pair-net, contact-net and constant differ in what they accept. */
#pragma once
#include "common/settings.h"
#include "solvers/pair_network.h"

typedef struct PairSolver {
    PairNetwork network;
    int sweep_count;  /* of a network of single impulses */
    int *pair_counts; /* [body_count] in how many pairs each body is */
    size_t count_capacity;
} PairSolver;

/* Reads the settings network and k (10). NULL with error set where they are refused; name: of the method. */
PairSolver *pair_solver_create(const char *name, const Settings *chosen, Error *error);
void pair_solver_destroy(void *state);

/* Lets the network act on the step, in the way of its target: see pair_net.c and contact_net.c. */
bool pair_solver_solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error);
