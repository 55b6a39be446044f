/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The constant predictor: the mean of a network's training data in place of its prediction, applied as pair-net or
   contact-net applies the prediction; their setting net=off does the same. A baseline: a network has learned something
   only if it is more accurate. Fails by design: the mean change is too large for a resting box and too small for a
   struck one. */
#include "base/base.h"
#include "methods/methods.h"
#include "methods/solvers.h"

static const SettingSpec settings[] = {
    {"network", "file of the network with that training data (default: the scene's)", SETTING_OWN},
    PAIR_SOLVER_SWEEPS,
    {0}};

static void *create(const Settings *chosen, Error *error) {
    PairSolver *solver = pair_solver_create("constant", settings, chosen, error);
    if (solver != NULL) solver->network.constant = true;
    return solver;
}

const ContactSolverKind solver_constant = {
    .description = {.name = "constant",
                    .summary =
                        "baseline: predicts the mean of the training data of pair-net or contact-net for every pair",
                    .caption = "mean of the training data",
                    .settings = settings,
                    .role = METHOD_BASELINE,
                    .needs_network = true,
                    .chart = METHOD_NO_RUNS,
                    .chart_quick = METHOD_NO_RUNS,
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = pair_solver_solve,
    .destroy = pair_solver_destroy};
