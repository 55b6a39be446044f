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

/* By how much E rises where impulses change the velocities `before` into those that the sweeps are at. */
static double rise(const ContactProblem *problem, const ContactImpulse *change, const BodyVelocity *before,
                   const Sweeps *sweeps) {
    double sum = 0;
    for (int i = 0; i < problem->body_count; i++) {
        const ProblemBody *body = &problem->bodies[i];
        const SweepBody *now = &sweeps->bodies[i];
        if (body->inv_mass == 0.0f) continue;
        const double x = (double)before[i].linear.x, y = (double)before[i].linear.y, spin = (double)before[i].angular;
        const double by_x = (double)now->x - x, by_y = (double)now->y - y, by_spin = (double)now->spin - spin;
        sum += (by_x * (x + 0.5 * by_x) + by_y * (y + 0.5 * by_y)) / (double)body->inv_mass +
               by_spin * (spin + 0.5 * by_spin) / (double)body->inv_inertia;
    }
    for (int i = 0; i < problem->contact_count; i++)
        sum -= (double)problem->contacts[i].bias * (double)change[i].normal;
    return sum;
}

/* Begins from the impulses of the passes, which are in the solution, if they are the better start. That is overwritten. */
static bool begin_nearer(Sweeps *sweeps, const ContactProblem *problem, ContactSolution *solution) {
    if (!sweeps_begin(sweeps, sweeps_best_kernel(), problem, true, 1.0f)) return false;
    for (int i = 0; i < problem->body_count; i++) {
        const SweepBody *body = &sweeps->bodies[i];
        solution->velocities[i] = (BodyVelocity){vec2(body->x, body->y), body->spin};
    }
    ContactImpulse *change = solution->impulses;
    for (int i = 0; i < problem->contact_count; i++) {
        change[i].normal -= problem->contacts[i].warm_normal;
        change[i].tangent -= problem->contacts[i].warm_tangent;
    }
    sweeps_push(sweeps, change);
    /* Nor where it is no number. */
    return rise(problem, change, solution->velocities, sweeps) < 0 ||
           sweeps_begin(sweeps, sweeps->kernel, problem, true, 1.0f);
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
    bool begun = answer == FOREST_PART ? begin_nearer(&solver->sweeps, problem, solution)
                                       : sweeps_begin(&solver->sweeps, sweeps_best_kernel(), problem, true, 1.0f);
    if (!begun || !sweeps_run(&solver->sweeps, solver->sweep_count)) return error_memory(error, "robust");
    if (!sweeps_end(&solver->sweeps, solution))
        sequential_impulses_solve(problem, &options, solver->sweep_count, solution);
    return true;
}

const ContactSolverKind solver_robust = {
    "robust", "stacks solved as a whole from the ground up and back, else the engine", settings, create, solve,
    destroy};
