/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Block solver: sequential impulses that solve the two normal impulses of a pair together. Method, source and where it
   fails: sweeps/block.c. */
#include "solvers/solvers.h"
#include "solvers/stopping.h"
#include "sweeps/block.h"
#include "sweeps/sweeps.h"

#include <stdlib.h>

typedef struct BlockSolver {
    int sweep_count;
    StoppingRule rule;
    Sweeps sweeps;
} BlockSolver;

static const SettingSpec settings[] = {
    {"k", "sweeps over all contacts per step (default: the scene's, else 10)"}, STOPPING_SETTINGS, {NULL, NULL}};

static void *create(const Settings *chosen, Error *error) {
    int sweep_count = 10;
    StoppingRule rule = {0};
    if (!settings_int(chosen, "k", 1, SWEEPS_MAX, &sweep_count, error) || !stopping_read(&rule, chosen, error))
        return NULL;
    BlockSolver *solver = calloc(1, sizeof *solver);
    if (solver == NULL)
        error_memory(error, "block");
    else
        *solver = (BlockSolver){.sweep_count = sweep_count, .rule = rule};
    return solver;
}

static void solve_scalar(const BlockSolver *solver, const ContactProblem *problem, ContactSolution *solution) {
    block_solve(problem, solver->sweep_count, solution);
    for (int done = 0; stopping_needs_more_scalar(&solver->rule, done, problem, solution); done += STOPPING_BLOCK)
        for (int i = 0; i < STOPPING_BLOCK; i++) block_sweep(problem, solution);
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    BlockSolver *solver = state;
    if (sweeps_can(SWEEP_AVX2)) {
        if (!sweeps_begin_blocks(&solver->sweeps, problem) ||
            !stopping_run(&solver->rule, &solver->sweeps, problem, solver->sweep_count, sweeps_run_blocks))
            return error_memory(error, "block");
        if (sweeps_end(&solver->sweeps, solution)) return true;
    }
    solve_scalar(solver, problem, solution);
    return true;
}

static void destroy(void *state) {
    BlockSolver *solver = state;
    if (solver == NULL) return;
    sweeps_free(&solver->sweeps);
    free(solver);
}

const ContactSolverKind solver_block = {
    .description = {.name = "block",
                    .summary = "sequential impulses that solve both normal impulses of a pair together",
                    .caption = "both impulses of a pair at once",
                    .look = {METHOD_SKY, METHOD_PENTAGON},
                    .settings = settings,
                    .chart = METHOD_RUNS("k=5", "k=10", "k=20", "k=50", "k=100"),
                    .chart_quick = METHOD_RUNS("k=10"),
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = solve,
    .destroy = destroy};
