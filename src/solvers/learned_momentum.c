/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps with momentum (momentum.c) and learned factors: one per sweep, fitted to a scene and to the number of sweeps
   (impact_training/momentum_fit.h). Costs as much as momentum. Source: schedules learned for unrolled iterations, as in
   Gregor, LeCun, "Learning Fast Approximations of Sparse Coding" (2010). Fails on scenes that it was not fitted to:
   there the factors are no better than hand-tuned ones, or worse. */
#include "network/momentum_schedule.h"
#include "solvers/momentum.h"
#include "solvers/solvers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct LearnedMomentum {
    Momentum momentum;
    MomentumSchedules schedules;
    int sweep_count;
    const float *factors; /* [sweep_count], of the schedules */
} LearnedMomentum;

static const SettingSpec settings[] = {
    {"k", "sweeps over all contacts per step; must be in the file (default: the scene's, else 10)"},
    {"network", "file of the learned factors (default: the scene's)"},
    STOPPING_SETTINGS,
    {NULL, NULL}};

static void destroy(void *state) {
    LearnedMomentum *solver = state;
    if (solver == NULL) return;
    momentum_free(&solver->momentum);
    momentum_schedules_free(&solver->schedules);
    free(solver);
}

static bool refuse_count(const LearnedMomentum *solver, const char *path, Error *error) {
    char there[128] = "";
    for (int i = 0; i < solver->schedules.count; i++) {
        size_t used = strlen(there);
        snprintf(there + used, sizeof there - used, "%s%d", i > 0 ? ", " : "", solver->schedules.sweeps[i]);
    }
    return error_input(error, path, "has no factors for k=%d; it has them for %s", solver->sweep_count, there);
}

static void *create(const Settings *chosen, Error *error) {
    const char *path = settings_get(chosen, "network");
    if (path == NULL) {
        error_input(error, "learned-momentum", "the scene names no factors for it: use learned-momentum:network=FILE");
        return NULL;
    }
    LearnedMomentum *solver = calloc(1, sizeof *solver);
    if (solver == NULL) {
        error_memory(error, "learned-momentum");
        return NULL;
    }
    solver->sweep_count = 10;
    if (!settings_int(chosen, "k", 1, MOMENTUM_MAX_SWEEPS, &solver->sweep_count, error) ||
        !momentum_read_rule(&solver->momentum, chosen, error) ||
        !momentum_schedules_read(&solver->schedules, path, error))
        goto fail;
    solver->factors = momentum_schedules_find(&solver->schedules, solver->sweep_count);
    if (solver->factors != NULL) return solver;
    refuse_count(solver, path, error);
fail:
    destroy(solver);
    return NULL;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    LearnedMomentum *solver = state;
    return momentum_solve(&solver->momentum, problem, solver->factors, solver->sweep_count, solution, error);
}

const ContactSolverKind solver_learned_momentum = {
    .description = {.name = "learned-momentum",
                    .summary = "momentum with learned factors, one per sweep",
                    .caption = "momentum with learned factors",
                    .look = {METHOD_ORANGE, METHOD_INVERTED_TRIANGLE},
                    .settings = settings,
                    .needs_network = true,
                    .twin = "momentum",
                    .chart = METHOD_RUNS("k=5", "k=10", "k=20", "k=50"),
                    .chart_quick = METHOD_RUNS("k=10", "k=20"),
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = solve,
    .destroy = destroy};
