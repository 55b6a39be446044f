/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The physics engine: sequential impulses with warm starting, as in Box2D-Lite. Method, source and where it fails:
   methods/sweeps_scalar.c. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/solvers.h"
#include "methods/sweeps.h"

static const SettingSpec settings[] = {
    SWEEPS_SETTING,
    {"accumulate", "on|off: clamp accumulated impulses, not each increment (default: the scene's, else on)",
     SETTING_BOOL(SweepState, options.accumulate)},
    {"warm", "on|off: warm start from the previous step's impulses (default: on)",
     SETTING_BOOL(SweepState, options.warm)},
    STOPPING_SETTINGS,
    {0}};

static void *create(const Settings *chosen, Error *error) {
    static const SweepState standard = {.rule.k = 10,
                                        .options = {.accumulate = true, .warm = true, .relaxation = 1.0f}};
    return stopping_make(chosen, settings, &standard, sizeof standard, "engine", error);
}

static void solve_scalar(const SweepState *solver, const ContactProblem *problem, ContactSolution *solution) {
    sequential_impulses_solve(problem, &solver->options, solver->rule.k, solution);
    for (int done = 0; stopping_needs_more_scalar(&solver->rule, done, problem, solution); done += STOPPING_BLOCK)
        for (int i = 0; i < STOPPING_BLOCK; i++) sequential_impulses_sweep(problem, &solver->options, solution);
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    SweepState *solver = state;
    const SequentialOptions *options = &solver->options;
    if (options->accumulate) {
        if (!sweeps_begin(&solver->sweeps, sweeps_best_kernel(), problem, options->warm, options->relaxation) ||
            !stopping_run(&solver->rule, &solver->sweeps, problem, sweeps_run))
            return error_memory(error, "engine");
        if (sweeps_end(&solver->sweeps, solution)) return true;
    }
    solve_scalar(solver, problem, solution);
    return true;
}

const ContactSolverKind solver_engine = {
    .description = {.name = "engine",
                    .summary = "sequential impulses with warm starting: the physics engine",
                    .caption = "physics engine, sequential impulses",
                    .look = {METHOD_BLUE, METHOD_CIRCLE},
                    .settings = settings,
                    .shipped = "k=10",
                    .chart = METHOD_RUNS("k=1", "k=4", "k=10", "k=20", "k=50", "k=100"),
                    .chart_quick = METHOD_RUNS("k=4", "k=10", "k=50"),
                    .stability = METHOD_RUNS("k=4", "", "k=50"),
                    .stability_place = 1},
    .create = create,
    .solve = solve,
    .destroy = sweep_state_destroy};
