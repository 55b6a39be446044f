/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Projected successive over-relaxation: sequential impulses (sweeps_scalar.c) with every increment scaled by
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

static const SettingSpec settings[] = {SWEEPS_SETTING,
                                       {"omega", "factor of every increment, from 0.01 to 1.99 (default: 1.5)",
                                        SETTING_FLOAT(SweepState, options.relaxation, 0.01f, 1.99f)},
                                       STOPPING_SETTINGS,
                                       {0}};

static void *create(const Settings *chosen, Error *error) {
    static const SweepState standard = {.rule.k = 10,
                                        .options = {.accumulate = true, .warm = true, .relaxation = 1.5f}};
    return stopping_make(chosen, settings, &standard, sizeof standard, "over-relaxation", error);
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    SweepState *solver = state;
    if (!sweeps_begin(&solver->sweeps, sweeps_best_kernel(), problem, true, solver->options.relaxation) ||
        !stopping_run(&solver->rule, &solver->sweeps, problem, sweeps_run))
        return error_memory(error, "over-relaxation");
    if (!sweeps_end(&solver->sweeps, solution))
        sequential_impulses_solve(problem, &solver->options, solver->rule.k, solution);
    return true;
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
    .destroy = sweep_state_destroy};
