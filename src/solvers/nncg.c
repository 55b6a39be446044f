/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NNCG: nonsmooth nonlinear conjugate gradients over the sweeps of sequential impulses.

   A sweep turns the impulses p into p'. Its step is taken for a steepest descent, and the steps are made conjugate
   as Fletcher and Reeves do:

       g = p - p',   beta = |g|^2 / |g of the sweep before|^2,   p = p' + beta d,   d = beta d - g,

   begun anew (p = p', d = -g) where beta > 1. Velocities are linear in the impulses, so they follow by the same
   recursion. The last thing done is a sweep: what is handed out is in the friction cone. Source: Silcowitz, Niebuhr,
   Poulsen, Erleben, "A Nonsmooth Nonlinear Conjugate Gradient Method for Interactive Contact Force Problems" (2010).
   Fails where few sweeps are allowed or friction makes the steps run in circles: then it is no better than those.

   Bit-exact: the sweeps are the engine's (sweeps.h), and |g|^2 is summed in a fixed order. */
#include "common/array.h"
#include "solvers/solvers.h"
#include "solvers/sweeps.h"

#include <stdlib.h>
#include <string.h>

/* Four numbers that are extrapolated alike: the impulse sums of a pair or the row of a body. */
typedef struct NncgRow {
    float values[4];
} NncgRow;

_Static_assert(sizeof(NncgRow) == sizeof(SweepBody), "a body is a row");
_Static_assert(sizeof(NncgRow) == 2 * sizeof(ContactImpulse), "the sums of a pair are a row");

typedef struct Nncg {
    int sweep_count;
    SweepKernel kernel;
    Sweeps sweeps;
    NncgRow *pair_before, *pair_direction; /* [pair_count] p and d */
    NncgRow *body_before, *body_direction; /* [body_count] the same of the velocities */
    size_t pair_capacity[2], body_capacity[2];
} Nncg;

static const SettingSpec settings[] = {{"k", "sweeps over all contacts a step (the scene's own: 10)"}, {NULL, NULL}};

static void *create(const Settings *chosen, Error *error) {
    Nncg options = {.sweep_count = 10};
    options.kernel = sweeps_can(SWEEP_AVX2) ? SWEEP_AVX2 : SWEEP_ONE_BY_ONE;
    if (!settings_int(chosen, "k", 1, 1000000, &options.sweep_count, error)) return NULL;
    Nncg *solver = malloc(sizeof *solver);
    if (solver == NULL)
        error_memory(error, "nncg");
    else
        *solver = options;
    return solver;
}

static bool reserve_two(NncgRow **before, NncgRow **direction, size_t capacity[2], int count) {
    return array_reserve((void **)before, &capacity[0], (size_t)count + 1, sizeof **before) &&
           array_reserve((void **)direction, &capacity[1], (size_t)count + 1, sizeof **direction);
}

/* Room for directions, which begin as zeros, and what the sums and velocities are now. */
static bool begin(Nncg *solver) {
    const Sweeps *sweeps = &solver->sweeps;
    if (!reserve_two(&solver->pair_before, &solver->pair_direction, solver->pair_capacity, sweeps->pair_count) ||
        !reserve_two(&solver->body_before, &solver->body_direction, solver->body_capacity, sweeps->body_count))
        return false;
    memset(solver->pair_direction, 0, (size_t)sweeps->pair_count * sizeof *solver->pair_direction);
    memset(solver->body_direction, 0, (size_t)sweeps->body_count * sizeof *solver->body_direction);
    memcpy(solver->body_before, sweeps->bodies, (size_t)sweeps->body_count * sizeof *solver->body_before);
    for (int i = 0; i < sweeps->pair_count; i++)
        memcpy(&solver->pair_before[i], sweeps->pairs[i].sums, sizeof *solver->pair_before);
    return true;
}

#ifdef EXPERIMENT
int nncg_weight, nncg_pr;
#endif
/* |g|^2 in eight partial sums, so that they fit in vector registers: even and odd pairs, each by point and
   direction. */
static float squared_step(const Nncg *solver) {
    float partial[2][4] = {{0}};
    for (int i = 0; i < solver->sweeps.pair_count; i++) {
        const ContactImpulse *sums = solver->sweeps.pairs[i].sums;
        const float *before = solver->pair_before[i].values;
        const float after[4] = {sums[0].normal, sums[0].tangent, sums[1].normal, sums[1].tangent};
#ifdef EXPERIMENT
        const SweepPoint *p = solver->sweeps.pairs[i].points;
        const float mass[4] = {p[0].mass_normal, p[0].mass_tangent, p[1].mass_normal, p[1].mass_tangent};
        if (nncg_weight) {
            for (int k = 0; k < 4; k++) if (mass[k] > 0)
                partial[i % 2][k] += (after[k] - before[k]) * (after[k] - before[k]) / (nncg_weight == 1 ? mass[k] : mass[k] * mass[k]);
            continue;
        }
#endif
        for (int k = 0; k < 4; k++) partial[i % 2][k] += (after[k] - before[k]) * (after[k] - before[k]);
    }
    for (int k = 0; k < 4; k++) partial[0][k] += partial[1][k];
    return (partial[0][0] + partial[0][2]) + (partial[0][1] + partial[0][3]);
}

/* One row: p = p' + beta d and d = beta d - g; p is what the next sweep begins from. */
static void extrapolate_row(void *row, NncgRow *before, NncgRow *direction, float beta) {
    NncgRow now;
    memcpy(&now, row, sizeof now);
    for (int k = 0; k < 4; k++) {
        float step = now.values[k] - before->values[k], carried = beta * direction->values[k];
        now.values[k] += carried;
        direction->values[k] = carried + step;
    }
    *before = now;
    memcpy(row, &now, sizeof now);
}

static void extrapolate(Nncg *solver, float beta) {
    Sweeps *sweeps = &solver->sweeps;
    for (int i = 0; i < sweeps->pair_count; i++)
        extrapolate_row(sweeps->pairs[i].sums, &solver->pair_before[i], &solver->pair_direction[i], beta);
    for (int i = 0; i < sweeps->body_count; i++)
        extrapolate_row(&sweeps->bodies[i], &solver->body_before[i], &solver->body_direction[i], beta);
}

/* False when memory is short. */
static bool run(Nncg *solver, SweepKernel kernel, const ContactProblem *problem) {
    if (!sweeps_begin(&solver->sweeps, kernel, problem) || !begin(solver)) return false;
    float before = 0;
    for (int sweep = 1; sweep < solver->sweep_count; sweep++) {
        if (!sweeps_run(&solver->sweeps, 1)) return false;
        float squared = squared_step(solver);
        extrapolate(solver, squared < before ? squared / before : 0.0f);
        before = squared;
    }
    return sweeps_run(&solver->sweeps, 1);
}

/* Where a number is not finite the order of visits may show: then one by one, which is the same everywhere. */
static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Nncg *solver = state;
    if (!run(solver, solver->kernel, problem)) return error_memory(error, "nncg");
    if (sweeps_end(&solver->sweeps, solution) || solver->kernel == SWEEP_ONE_BY_ONE) return true;
    if (!run(solver, SWEEP_ONE_BY_ONE, problem)) return error_memory(error, "nncg");
    sweeps_end(&solver->sweeps, solution);
    return true;
}

static void destroy(void *state) {
    Nncg *solver = state;
    if (solver == NULL) return;
    sweeps_free(&solver->sweeps);
    free(solver->pair_before);
    free(solver->pair_direction);
    free(solver->body_before);
    free(solver->body_direction);
    free(solver);
}

const ContactSolverKind solver_nncg = {
    "nncg", "sweeps made conjugate: nonsmooth nonlinear conjugate gradients", settings, create, solve, destroy};
