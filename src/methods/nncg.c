/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NNCG: nonsmooth nonlinear conjugate gradients over the sweeps of sequential impulses.

   A sweep turns the impulses p into p'. Its step p' - p serves as the direction of steepest descent, and the steps are
   made conjugate by the formula of Fletcher and Reeves:

       g = p - p',   beta = min(|g|^2 / |previous g|^2, 1),   p = p' + beta d,   d = beta d - g,

   restarted (p = p', d = 0) if the sweep goes against the direction, g . d > 0. Each island has its own products, so
   its impulses do not depend on what happens elsewhere. Velocities are linear in the impulses, so they follow by the
   same recursion. A sweep comes last, so the result is inside the friction cones. Source:
   Silcowitz, Niebuhr, Poulsen, Erleben, "A Nonsmooth Nonlinear Conjugate Gradient Method for Interactive Contact Force
   Problems" (2010). They restart if |g| grows, which happens often and without harm at impacts; the test used here is
   that of O'Donoghue and Candes, "Adaptive Restart for Accelerated Gradient Schemes" (2015), and leaves half to four
   fifths of the error at impacts. Fails with few sweeps: up to about ten it may be less accurate than sweeps alone. A
   sweep costs as much as two of the engine's, because sweeps cannot overlap: each waits for beta.

   Bit-exact: the sweeps are the engine's (sweeps.h), and products are summed in a fixed order. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/stopping.h"
#include "methods/sweeps.h"

#include <stdlib.h>
#include <string.h>

/* Four numbers that are extrapolated together: the accumulated impulses of a pair, or the velocity of a body with its
   inverse mass, which no sweep changes. */
typedef struct NncgRow {
    float values[4];
} NncgRow;

_Static_assert(sizeof(NncgRow) == sizeof(SweepBody), "a body is a row");
_Static_assert(sizeof(NncgRow) == sizeof((SweepPair){0}).sums, "the sums of a pair are a row");

/* Products of the last sweep's step, -g, in eight partial sums, as in vector registers: of even and odd pairs of the
   island, of each point and direction. */
typedef struct NncgIsland {
    float squared[2][4]; /* |g|^2 */
    float along[2][4];   /* -g . d */
    int pairs;           /* so far */
    float before;        /* |g|^2 of the sweep before */
    float beta;
    bool restarts;
} NncgIsland;

typedef struct Nncg {
    StoppingRule rule;
    Sweeps sweeps;
    NncgRow *pair_before, *pair_direction; /* [pair_count] p and d */
    NncgRow *body_before, *body_direction; /* [body_count] the same of the velocities */
    NncgIsland *islands;                   /* [sweeps.groups] */
    ArrayBlock arrays;
} Nncg;

static const SettingSpec settings[] = {SWEEPS_SETTING, STOPPING_SETTINGS("sweeps"), KEEP_SETTING(SETTING_OWN), {0}};

static void *nncg_create(const Settings *chosen, Error *error) {
    static const Nncg standard = {.rule.k = 10};
    return stopping_make(chosen, settings, &standard, sizeof standard, "nncg", error);
}

static bool nncg_reserve(Nncg *solver) {
    const size_t pairs = (size_t)solver->sweeps.pair_count, bodies = (size_t)solver->sweeps.body_count;
    return ARRAY_BLOCK_RESERVE(&solver->arrays, ARRAY_PART(solver->pair_before, pairs),
                               ARRAY_PART(solver->pair_direction, pairs), ARRAY_PART(solver->body_before, bodies),
                               ARRAY_PART(solver->body_direction, bodies), ARRAY_PART(solver->islands, pairs));
}

/* d = 0 */
static void begin_all(Nncg *solver) {
    const Sweeps *sweeps = &solver->sweeps;
    size_t bodies = (size_t)sweeps->body_count * sizeof(NncgRow), pairs = (size_t)sweeps->pair_count * sizeof(NncgRow);
    memset(solver->body_direction, 0, bodies);
    memset(solver->pair_direction, 0, pairs);
    memcpy(solver->body_before, sweeps->bodies, bodies);
    for (int i = 0; i < sweeps->pair_count; i++)
        memcpy(&solver->pair_before[i], sweeps->pairs[i].sums, sizeof *solver->pair_before);
    for (int k = 0; k < sweeps->groups; k++) solver->islands[k].before = 0;
}

static float add_up(float partial[2][4]) {
    for (int k = 0; k < 4; k++) partial[0][k] += partial[1][k];
    return (partial[0][0] + partial[0][2]) + (partial[0][1] + partial[0][3]);
}

static void nncg_decide(NncgIsland *island) {
    const float squared = add_up(island->squared);
    island->restarts = add_up(island->along) < 0.0f;
    island->beta = squared < island->before ? squared / island->before : 1.0f;
    island->before = squared;
}

static void nncg_measure(Nncg *solver) {
    const Sweeps *sweeps = &solver->sweeps;
    for (int k = 0; k < sweeps->groups; k++) solver->islands[k] = (NncgIsland){.before = solver->islands[k].before};
    for (int i = 0; i < sweeps->pair_count; i++) {
        NncgIsland *island = &solver->islands[sweeps->group[i]];
        const int odd = island->pairs++ % 2;
        NncgRow after;
        memcpy(&after, sweeps->pairs[i].sums, sizeof after);
        for (int k = 0; k < 4; k++) {
            float step = after.values[k] - solver->pair_before[i].values[k];
            island->squared[odd][k] += step * step;
            island->along[odd][k] += step * solver->pair_direction[i].values[k];
        }
    }
    for (int k = 0; k < sweeps->groups; k++) nncg_decide(&solver->islands[k]);
}

/* p = p' + beta d and d = beta d - g for one row; or p = p' and d = 0. */
static void extrapolate_row(void *row, NncgRow *before, NncgRow *direction, const NncgIsland *island) {
    static const NncgRow none;
    NncgRow now;
    memcpy(&now, row, sizeof now);
    for (int k = 0; k < 4 && !island->restarts; k++) {
        float step = now.values[k] - before->values[k], carried = island->beta * direction->values[k];
        now.values[k] -= 0.0f - carried; /* a change of 0 keeps -0 */
        direction->values[k] = carried + step;
    }
    if (island->restarts) *direction = none;
    *before = now;
    memcpy(row, &now, sizeof now);
}

static void nncg_extrapolate(Nncg *solver) {
    Sweeps *sweeps = &solver->sweeps;
    for (int i = 0; i < sweeps->pair_count; i++)
        extrapolate_row(sweeps->pairs[i].sums, &solver->pair_before[i], &solver->pair_direction[i],
                        &solver->islands[sweeps->group[i]]);
    for (int i = 0; i < sweeps->body_count; i++)
        extrapolate_row(&sweeps->bodies[i], &solver->body_before[i], &solver->body_direction[i],
                        &solver->islands[sweeps->group_of_body[i]]);
}

/* True after sweep number `sweep`, counted from 1, if none follows. */
static bool is_last(const Nncg *solver, int sweep, const ContactProblem *problem) {
    const int done = sweep - solver->rule.k;
    return done >= 0 && done % STOPPING_BLOCK == 0 &&
           !stopping_needs_more(&solver->rule, done, &solver->sweeps, problem);
}

/* False when memory is short. */
static bool nncg_run(Nncg *solver, SweepKernel kernel, const ContactProblem *problem) {
    if (!sweeps_begin(&solver->sweeps, kernel, problem, true) || !nncg_reserve(solver)) return false;
    if (solver->sweeps.pair_count == 0) return true; /* and no island */
    sweeps_group(&solver->sweeps);
    begin_all(solver);
    for (int sweep = 1;; sweep++) {
        if (!sweeps_run(&solver->sweeps, 1)) return false;
        if (is_last(solver, sweep, problem)) return true;
        nncg_measure(solver);
        nncg_extrapolate(solver);
    }
}

/* NaN and infinite numbers may depend on the order of visits; so they are computed one by one, the same everywhere. */
static bool nncg_solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Nncg *solver = state;
    if (!nncg_run(solver, sweeps_best_kernel(), problem)) return error_memory(error, "nncg");
    if (sweeps_end(&solver->sweeps, solution) || solver->sweeps.kernel == SWEEP_ONE_BY_ONE) return true;
    if (!nncg_run(solver, SWEEP_ONE_BY_ONE, problem)) return error_memory(error, "nncg");
    sweeps_end(&solver->sweeps, solution);
    return true;
}

static void nncg_destroy(void *state) {
    Nncg *solver = state;
    if (solver == NULL) return;
    sweeps_free(&solver->sweeps);
    free(solver->arrays.memory);
    free(solver);
}

const ContactSolverKind solver_nncg = {
    .description = {.name = "nncg",
                    .summary = "nonsmooth nonlinear conjugate gradients over sweeps",
                    .caption = "conjugate gradients over sweeps",
                    .settings = settings,
                    .converges = "k=200",
                    .chart = METHOD_RUNS("k=5", "k=20", "k=50", "k=1,near=0.5,more=10000", "k=1,near=0.02,more=10000",
                                         "k=5,near=0.02,more=10000", "k=5,near=0.001,more=10000",
                                         "k=5,near=0.0002,more=10000"),
                    .chart_quick = METHOD_RUNS("k=20", "k=1,near=0.02,more=10000"),
                    .stability_place = 5},
    .create = nncg_create,
    .solve = nncg_solve,
    .destroy = nncg_destroy};
