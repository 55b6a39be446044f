/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interior-point steps with a sparse direct solve over the bodies; equations and sources in interior/interior.h. Two
   sweeps make the start. Ends when the residual is at most `near`. If it never is, sweeps with momentum solve the step
   instead, unless their residual is larger; the solution counts this as a fallback.

   The residual falls about sevenfold with each of the last iterations: a hundred times the accuracy costs two or three
   more. Fails by its time: an iteration costs as much as about ten sweeps, and more than that beyond some hundred bodies;
   a frozen impact of scenes/pyramid_settled takes twelve iterations, one of scenes/stack five. */
#include "interior/interior.h"

#include "solvers/interior_net.h"
#include "solvers/momentum.h"
#include "solvers/residual.h"
#include "solvers/solvers.h"

#include <stdlib.h>

enum {
    ITERATIONS_MAX = 40,
    FALLBACK_SWEEPS = 14, /* with momentum, and then more while the residual is too large */
    FALLBACK_MORE = 96,
    CHECK_EVERY = 8
};

/* A step is at rest if contacts approach by less than `rest_below`. Then the tolerance is at most `rest_near`, as errors
   of boxes at rest add up along a stack and from step to step. Shallow contacts aim to close by the same speed: it
   exceeds the rounding of positions. */
static const double rest_below = 0.5, rest_near = 0.001; /* m/s */

typedef struct State {
    Interior interior;
    Momentum momentum;
    InteriorNet net; /* of interior-net */
    float near;      /* m/s */
    float factors[FALLBACK_SWEEPS], more_factors[FALLBACK_MORE];
} State;

static const SettingSpec settings[] = {{"near", "residual at which iterations stop, m/s (default: 0.02)"},
                                       {NULL, NULL}};

static void destroy(void *state) {
    State *solver = state;
    if (solver == NULL) return;
    interior_free(&solver->interior);
    momentum_free(&solver->momentum);
    free(solver);
}

static void *create(const Settings *chosen, Error *error) {
    float near = 0.02f;
    if (!settings_float(chosen, "near", 1e-9f, 1e6f, &near, error)) return NULL;
    State *solver = calloc(1, sizeof *solver);
    if (solver == NULL) {
        error_memory(error, "interior");
        return NULL;
    }
    solver->near = near;
    for (int s = 0; s < FALLBACK_SWEEPS; s++) solver->factors[s] = momentum_factor_tuned(s, FALLBACK_SWEEPS);
    for (int s = 0; s < FALLBACK_MORE; s++) solver->more_factors[s] = momentum_factor_tuned(s, FALLBACK_MORE);
    return solver;
}

/* False when memory is short. */
static bool iterate(State *solver, const ContactProblem *problem) {
    const InteriorKernels *kernels = interior_best();
    Sweeps *sweeps = &solver->momentum.sweeps;
    if (!sweeps_begin_coloured(sweeps, sweeps_best_kernel(), problem) || !sweeps_run(sweeps, INTERIOR_START_SWEEPS) ||
        !interior_load(&solver->interior, kernels, sweeps, problem))
        return false;
    const double near = (double)solver->near, least = near < rest_near ? near : rest_near;
    const bool rests = interior_approach(&solver->interior) < rest_below;
    interior_close(&solver->interior, least, CONTACT_SLOP / 2);
    interior_iterate(&solver->interior, kernels, rests ? least : near, ITERATIONS_MAX);
    return true;
}

static bool sweep(State *solver, const ContactProblem *problem) {
    Sweeps *sweeps = &solver->momentum.sweeps;
    if (!sweeps_begin_coloured(sweeps, sweeps_best_kernel(), problem) ||
        !sweeps_run_momentum(sweeps, solver->factors, FALLBACK_SWEEPS))
        return false;
    for (int s = 0; s < FALLBACK_MORE && residual_reaches(sweeps, problem->contact_count, solver->near);
         s += CHECK_EVERY)
        if (!(s == 0 ? sweeps_run_momentum(sweeps, solver->more_factors, CHECK_EVERY)
                     : sweeps_continue_momentum(sweeps, solver->more_factors + s, CHECK_EVERY)))
            return false;
    return true;
}

/* The solution of the iterations is stored. Replaces it if the residual of sweeps is smaller. */
static bool fall_back(State *solver, bool finite, const ContactProblem *problem, ContactSolution *solution,
                      Error *error) {
    const double before = solver->interior.residual;
    Sweeps *sweeps = &solver->momentum.sweeps;
    if (!sweep(solver, problem) || !interior_load(&solver->interior, interior_best(), sweeps, problem))
        return error_memory(error, "interior");
    if (finite && before <= solver->interior.residual) return true;
    solution->fallbacks.by_sweeps = 1;
    return sweeps_end(sweeps, solution) ||
           momentum_solve(&solver->momentum, problem, solver->factors, FALLBACK_SWEEPS, solution, error);
}

bool interior_net_make(ContactSolver *solver, const InteriorNet *net, Error *error) {
    const Settings none = {0};
    State *state = create(&none, error);
    if (state == NULL) return false;
    state->net = *net;
    state->interior.net = &state->net;
    *solver = (ContactSolver){&solver_interior_net, state};
    return true;
}

static void *create_net(const Settings *chosen, Error *error) {
    const char *path = settings_get(chosen, "network");
    if (path == NULL) {
        error_input(error, "interior-net", "the scene names no network for it: use interior-net:network=FILE");
        return NULL;
    }
    State *solver = create(chosen, error);
    if (solver == NULL) return NULL;
    if (!interior_net_read(&solver->net, path, error)) {
        destroy(solver);
        return NULL;
    }
    solver->interior.net = &solver->net;
    return solver;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    State *solver = state;
    if (!iterate(solver, problem)) return error_memory(error, "interior");
    const bool finite = interior_end(&solver->interior, &solver->momentum.sweeps, problem, solution);
    if (finite && solver->interior.residual <= (double)solver->near) return true;
    return fall_back(solver, finite, problem, solution, error);
}

const ContactSolverKind solver_interior = {
    .description = {.name = "interior",
                    .summary = "interior-point steps with a sparse direct solve over the bodies",
                    .settings = settings,
                    .title = "Interior point",
                    .chart = METHOD_RUNS("near=0.02", "near=0.001"),
                    .chart_quick = METHOD_NO_RUNS,
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = solve,
    .destroy = destroy};

static const SettingSpec net_settings[] = {{"near", "residual at which iterations stop, m/s (default: 0.02)"},
                                           {"network", "file of the network (default: the scene's)"},
                                           {NULL, NULL}};

const ContactSolverKind solver_interior_net = {
    .description = {.name = "interior-net",
                    .summary = "interior with a network that places each contact before an iteration",
                    .settings = net_settings,
                    .title = "Interior point with a network",
                    .needs_network = true,
                    .twin = "interior",
                    .chart = METHOD_RUNS("near=0.02", "near=0.001"),
                    .chart_quick = METHOD_NO_RUNS,
                    .stability = METHOD_NO_RUNS},
    .create = create_net,
    .solve = solve,
    .destroy = destroy};
