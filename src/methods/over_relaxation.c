/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Projected successive over-relaxation: sequential impulses (methods/sweeps_scalar.c) with every increment scaled by
   omega,

       Pn' = max(Pn + omega mass_n (bias - vn), 0),   Pt' = clamp(Pt - omega mass_t vt, -mu Pn', mu Pn')

   omega < 1 damps, omega > 1 extrapolates. Source: Cryer, "The Solution of a Quadratic Programming Problem Using
   Systematic Overrelaxation" (1971); in games Erleben, "Stable, Robust, and Versatile Multibody Dynamics Animation"
   (2005). Fails as sequential impulses do, somewhat later: an impulse still travels one contact per sweep, and
   later sweeps must correct the overshoot at an impact. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/solvers.h"
#include "methods/sweeps.h"

#include <stdlib.h>

typedef struct OverRelaxation {
    int sweep_count;
    StoppingRule rule;
    SequentialOptions options;
    Sweeps sweeps;
} OverRelaxation;

static const SettingSpec settings[] = {{"k", "sweeps over all contacts per step (default: the scene's, else 10)"},
                                       {"omega", "factor of every increment, from 0.01 to 1.99 (default: 1.5)"},
                                       STOPPING_SETTINGS,
                                       {NULL, NULL}};

static void *create(const Settings *chosen, Error *error) {
    OverRelaxation values = {.sweep_count = 10, .options = {.accumulate = true, .warm = true, .relaxation = 1.5f}};
    if (!settings_int(chosen, "k", 1, SWEEPS_MAX, &values.sweep_count, error) ||
        !settings_float(chosen, "omega", 0.01f, 1.99f, &values.options.relaxation, error) ||
        !stopping_read(&values.rule, chosen, error))
        return NULL;
    OverRelaxation *solver = malloc(sizeof *solver);
    if (solver == NULL)
        error_memory(error, "over-relaxation");
    else
        *solver = values;
    return solver;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    OverRelaxation *solver = state;
    if (!sweeps_begin(&solver->sweeps, sweeps_best_kernel(), problem, true, solver->options.relaxation) ||
        !stopping_run(&solver->rule, &solver->sweeps, problem, solver->sweep_count, sweeps_run))
        return error_memory(error, "over-relaxation");
    if (!sweeps_end(&solver->sweeps, solution))
        sequential_impulses_solve(problem, &solver->options, solver->sweep_count, solution);
    return true;
}

static void destroy(void *state) {
    OverRelaxation *solver = state;
    if (solver == NULL) return;
    sweeps_free(&solver->sweeps);
    free(solver);
}

const ContactSolverKind solver_over_relaxation = {
    .description = {.name = "over-relaxation",
                    .summary = "projected successive over-relaxation: sequential impulses with scaled increments",
                    .caption = "scaled sequential impulses",
                    .look = {METHOD_VERMILION, METHOD_SQUARE},
                    .settings = settings,
                    .chart = METHOD_RUNS("k=5", "k=10", "k=20", "k=50", "k=100"),
                    .chart_quick = METHOD_RUNS("k=10"),
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = solve,
    .destroy = destroy};
