/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a network's training data were on average, said for every pair in place of what the network says, and used in
   the same way: by its target as pair-net does or as contact-net does. It is no method, but the mark that one has to
   beat before it can be said to have learned anything. Fails by design: what is right on average is too much for
   a box at rest and too little for one that is struck. */
#include "solvers/pair_solver.h"
#include "solvers/solvers.h"

static const SettingSpec settings[] = {
    {"network", "file of the network whose training data it was (the scene's own)"},
    {"k", "sweeps over all pairs a step, for data of single impulses (the scene's own: 10)"},
    {NULL, NULL}};

static void *create(const Settings *chosen, Error *error) {
    PairSolver *solver = pair_solver_create("constant", chosen, error);
    if (solver != NULL) solver->network.constant = true;
    return solver;
}

const ContactSolverKind solver_constant = {
    .description = {.name = "constant",
                    .summary = "what pair-net or contact-net was trained on, on average: the same for every pair",
                    .settings = settings,
                    .role = METHOD_BASELINE,
                    .needs_network = true,
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = pair_solver_solve,
    .destroy = pair_solver_destroy};
