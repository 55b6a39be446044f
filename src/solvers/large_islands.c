/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "solvers/large_islands.h"

enum { LOOPS_MAX = 700 }; /* of an island that is factorized */

void large_islands_init(LargeIslands *large) {
    for (int s = 0; s < LARGE_SWEEPS; s++) large->factors[s] = momentum_factor_tuned(s, LARGE_SWEEPS);
    for (int s = 0; s < LARGE_MORE; s++) large->more_factors[s] = momentum_factor_tuned(s, LARGE_MORE);
}

void large_islands_free(LargeIslands *large) { islands_free(&large->islands); }

bool large_islands_find(LargeIslands *large, const ContactProblem *problem, bool *left_to_sweeps, Error *error) {
    *left_to_sweeps = false;
    if (problem->contact_count <= LOOPS_MAX) return true; /* each pair has a contact */
    const int loops = islands_most_loops(&large->islands, problem);
    *left_to_sweeps = loops > LOOPS_MAX;
    return loops >= 0 || error_memory(error, "interior");
}

bool large_islands_solve(const LargeIslands *large, Momentum *momentum, float near, const ContactProblem *problem,
                         ContactSolution *solution, Error *error) {
    Sweeps *sweeps = &momentum->sweeps;
    const StoppingRule rule = {.near = near, .more = LARGE_MORE};
    if (!sweeps_begin_coloured(sweeps, sweeps_best_kernel(), problem) ||
        !sweeps_run_momentum(sweeps, large->factors, LARGE_SWEEPS) ||
        !momentum_run_more(sweeps, problem, &rule, large->more_factors))
        return error_memory(error, "interior");
    solution->fallbacks.by_sweeps = 1;
    return sweeps_end(sweeps, solution) ||
           momentum_solve(momentum, problem, large->factors, LARGE_SWEEPS, solution, error);
}
