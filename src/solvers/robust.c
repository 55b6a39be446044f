/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stacks as a whole, by two passes over what stands on the ground without loops (forest.h); where that solves all
   contacts there is nothing left to sweep. Otherwise the engine's sweeps, from whichever start has the lower

       E(P) = sum of m v^2 / 2 + I w^2 / 2 - sum of bias P_n,   v and w: after the impulses P

   the least of which is the solution without friction: the impulses of the step before, or those of the passes, where
   there are some. After a blow the latter are far better, or far worse. Source: forest.h; E: Baraff, "Fast Contact Force
   Computation for Nonpenetrating Rigid Bodies" (1994). Fails as the engine does where it falls back to it: in walls,
   bridges and arches, on corners, and while boxes tip or slide; a stack that a blow has shaken may so be lost. */
#include "solvers/forest.h"
#include "solvers/sequential_impulses.h"
#include "solvers/solvers.h"
#include "solvers/sweeps.h"

#include <stdlib.h>

typedef struct Robust {
    int sweep_count;
    Forest forest;
    Sweeps sweeps;
} Robust;

static const SettingSpec settings[] = {{"k", "sweeps a step where the passes do not solve it (the scene's own: 10)"},
                                       {NULL, NULL}};

static void destroy(void *state) {
    Robust *solver = state;
    if (solver == NULL) return;
    forest_free(&solver->forest);
    sweeps_free(&solver->sweeps);
    free(solver);
}

static void *create(const Settings *chosen, Error *error) {
    int sweep_count = 10;
    if (!settings_int(chosen, "k", 1, SWEEPS_MAX, &sweep_count, error)) return NULL;
    Robust *solver = calloc(1, sizeof *solver);
    if (solver == NULL)
        error_memory(error, "robust");
    else
        solver->sweep_count = sweep_count;
    return solver;
}

/* E of the impulses and velocities that the sweeps are at. */
static double objective(const ContactProblem *problem, const Sweeps *sweeps) {
    double sum = 0;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const SweepBody *now = &sweeps->bodies[i];
        if (body->inv_mass == 0.0f) continue;
        const double x = (double)now->x, y = (double)now->y, spin = (double)now->spin;
        sum += 0.5 * ((x * x + y * y) / (double)body->inv_mass + spin * spin / (double)body->inv_inertia);
    }
    for (int i = 0; i < sweeps->pair_count; i++)
        for (int k = 0; k < 2; k++)
            sum -= (double)sweeps->pairs[i].points[k].bias * (double)sweeps->pairs[i].sums[k].normal;
    return sum;
}

/* Begins from the impulses [contact_count] of the passes, which are overwritten, if they are the better start. */
static bool begin_nearer(Sweeps *sweeps, const ContactProblem *problem, ContactImpulse *impulses) {
    if (!sweeps_begin(sweeps, sweeps_best_kernel(), problem, true, 1.0f)) return false;
    const double warm = objective(problem, sweeps);
    for (int i = 0; i < problem->contact_count; i++) {
        impulses[i].normal -= problem->contacts[i].warm_normal;
        impulses[i].tangent -= problem->contacts[i].warm_tangent;
    }
    sweeps_push(sweeps, impulses);
    /* Not where E is no number, either. */
    return objective(problem, sweeps) < warm || sweeps_begin(sweeps, sweeps->kernel, problem, true, 1.0f);
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    static const SequentialOptions options = {.accumulate = true, .warm = true, .relaxation = 1.0f};
    Robust *solver = state;
    ForestAnswer answer;
    if (!forest_solve(&solver->forest, problem, solution->impulses, &answer)) return error_memory(error, "robust");
    if (answer == FOREST_WHOLE) {
        for (int i = 0; i < problem->body_count; i++) solution->velocities[i] = solver->forest.bodies[i].after;
        return true;
    }
    bool begun = answer == FOREST_PART ? begin_nearer(&solver->sweeps, problem, solution->impulses)
                                       : sweeps_begin(&solver->sweeps, sweeps_best_kernel(), problem, true, 1.0f);
    if (!begun || !sweeps_run(&solver->sweeps, solver->sweep_count)) return error_memory(error, "robust");
    if (!sweeps_end(&solver->sweeps, solution))
        sequential_impulses_solve(problem, &options, solver->sweep_count, solution);
    return true;
}

const ContactSolverKind solver_robust = {
    "robust", "stacks solved as a whole from the ground up and back, else the engine", settings, create, solve,
    destroy};
