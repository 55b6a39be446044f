/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The physics engine: sequential impulses with warm starting, as in Box2D-Lite. Method, source and where it fails:
   methods/sweeps_scalar.c.

   It also has Box2D-Lite's contacts, bit for bit, and so fails where they do: a box that slides over flush tiles
   catches at seams once it has sunk a little, and thin plates that lie on one another change places. With `keep`, and
   in other methods, contacts are mended (ContactRules). */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/stopping.h"
#include "methods/sweeps.h"

#include <stdlib.h>

typedef struct State {
    StoppingRule rule;
    SequentialOptions options;
    Sweeps sweeps;
} State;

static const SettingSpec settings[] = {
    SWEEPS_SETTING,
    {"accumulate", "on|off: clamp accumulated impulses, not each increment (default: the scene's, else on)",
     SETTING_BOOL(State, options.accumulate)},
    {"warm", "on|off: warm start from the previous step's impulses (default: on)", SETTING_BOOL(State, options.warm)},
    STOPPING_SETTINGS("sweeps"),
    KEEP_SETTING(SETTING_OWN),
    {0}};

static void engine_destroy(void *state) {
    State *solver = state;
    if (solver == NULL) return;
    sweeps_free(&solver->sweeps);
    free(solver);
}

static void *engine_create(const Settings *chosen, Error *error) {
    static const State standard = {.rule.k = 10, .options = {.accumulate = true, .warm = true}};
    return stopping_make(chosen, settings, &standard, sizeof standard, "engine", error);
}

static bool engine_sweep(State *solver, const ContactProblem *problem) {
    const StoppingRule *rule = &solver->rule;
    Sweeps *sweeps = &solver->sweeps;
    sweeps->block = rule->more > 0 ? STOPPING_BLOCK : 0;
    if (!sweeps_run(sweeps, rule->k)) return false;
    for (int done = 0; stopping_needs_more(rule, done, sweeps, problem); done += STOPPING_BLOCK)
        if (!sweeps_run(sweeps, STOPPING_BLOCK)) return false;
    return true;
}

static void solve_scalar(const State *solver, const ContactProblem *problem, ContactSolution *solution) {
    sequential_impulses_solve(problem, &solver->options, solver->rule.k, solution);
    for (int done = 0; stopping_needs_more_scalar(&solver->rule, done, problem, solution); done += STOPPING_BLOCK)
        for (int i = 0; i < STOPPING_BLOCK; i++) sequential_impulses_sweep(problem, &solver->options, solution);
}

static bool engine_solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    State *solver = state;
    const SequentialOptions *options = &solver->options;
    if (options->accumulate) {
        if (!sweeps_begin(&solver->sweeps, sweeps_best_kernel(), problem, options->warm) ||
            !engine_sweep(solver, problem))
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
                    .settings = settings,
                    .shipped = "k=10",
                    .converges = "k=20000,warm=off",
                    .lite_contacts = true,
                    .chart = METHOD_RUNS("k=5", "k=10", "k=50", "k=100", "k=2,near=0.1,more=400",
                                         "k=2,near=0.001,more=10000"),
                    .chart_quick = METHOD_RUNS("k=4", "k=10", "k=50"),
                    .stability = METHOD_RUNS("k=4", "", "k=50"),
                    .stability_place = 1},
    .create = engine_create,
    .solve = engine_solve,
    .destroy = engine_destroy};
