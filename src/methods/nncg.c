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
   fifths of the error at impacts. Sweeps visit contacts in the order of colours: only visits of one sweep can overlap,
   as the next one waits for beta. That takes 0.4 to 0.7 of the time in the problem's order, and leaves less error at
   impacts, but stacks at rest need more sweeps: ten hold 19 boxes instead of 22. A sweep costs as much as one with
   momentum. Fails with few sweeps: with five, dominoes have more error than with as many of the engine's.

   Bit-exact: products are summed in a fixed order, that of the visits. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/islands.h"
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
    Islands parts;
} Nncg;

static const SettingSpec settings[] = {SWEEPS_SETTING, STOPPING_SETTINGS("sweeps"), KEEP_SETTING(SETTING_OWN), {0}};

static void *create(const Settings *chosen, Error *error) {
    static const Nncg standard = {.rule.k = 10};
    return stopping_make(chosen, settings, &standard, sizeof standard, "nncg", error);
}

static float add_up(float partial[2][4]) {
    for (int k = 0; k < 4; k++) partial[0][k] += partial[1][k];
    return (partial[0][0] + partial[0][2]) + (partial[0][1] + partial[0][3]);
}

static void measure(Nncg *solver) {
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
    for (int k = 0; k < sweeps->groups; k++) {
        NncgIsland *island = &solver->islands[k];
        const float squared = add_up(island->squared);
        island->restarts = add_up(island->along) < 0.0f;
        island->beta = squared < island->before ? squared / island->before : 1.0f;
        island->before = squared;
    }
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

/* False when memory is short. */
static bool run(Nncg *solver, SweepKernel kernel, const ContactProblem *problem) {
    Sweeps *sweeps = &solver->sweeps;
    if (!sweeps_begin_coloured(sweeps, kernel, problem)) return false;
    const size_t pairs = (size_t)sweeps->pair_count, bodies = (size_t)sweeps->body_count;
    if (!ARRAY_BLOCK_RESERVE(&solver->arrays, ARRAY_PART(solver->pair_before, pairs),
                             ARRAY_PART(solver->pair_direction, pairs), ARRAY_PART(solver->body_before, bodies),
                             ARRAY_PART(solver->body_direction, bodies), ARRAY_PART(solver->islands, pairs)))
        return false;
    if (pairs == 0) return true; /* and no island */
    sweeps_group(sweeps);
    /* d = 0 */
    memset(solver->body_direction, 0, bodies * sizeof *solver->body_direction);
    memset(solver->pair_direction, 0, pairs * sizeof *solver->pair_direction);
    memcpy(solver->body_before, sweeps->bodies, bodies * sizeof *solver->body_before);
    for (size_t i = 0; i < pairs; i++)
        memcpy(&solver->pair_before[i], sweeps->pairs[i].sums, sizeof *solver->pair_before);
    for (int k = 0; k < sweeps->groups; k++) solver->islands[k].before = 0;
    for (int sweep = 1;; sweep++) {
        const int done = sweep - solver->rule.k;
        if (!sweeps_run(sweeps, 1)) return false;
        if (done >= 0 && done % STOPPING_BLOCK == 0 && !stopping_needs_more(&solver->rule, done, sweeps, problem))
            return true;
        measure(solver);
        for (int i = 0; i < sweeps->pair_count; i++)
            extrapolate_row(sweeps->pairs[i].sums, &solver->pair_before[i], &solver->pair_direction[i],
                            &solver->islands[sweeps->group[i]]);
        for (int i = 0; i < sweeps->body_count; i++)
            extrapolate_row(&sweeps->bodies[i], &solver->body_before[i], &solver->body_direction[i],
                            &solver->islands[sweeps->group_of_body[i]]);
    }
}

/* NaN and infinite numbers may depend on the order of visits; so they are computed one by one, the same everywhere. */
static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Nncg *solver = state;
    if (!run(solver, sweeps_best_kernel(), problem)) return error_memory(error, "nncg");
    if (!sweeps_end(&solver->sweeps, solution) && solver->sweeps.kernel != SWEEP_ONE_BY_ONE) {
        if (!run(solver, SWEEP_ONE_BY_ONE, problem)) return error_memory(error, "nncg");
        sweeps_end(&solver->sweeps, solution);
    }
    return islands_take_gain(&solver->parts, problem, solution) || error_memory(error, "nncg");
}

static void destroy(void *state) {
    Nncg *solver = state;
    if (solver == NULL) return;
    sweeps_free(&solver->sweeps);
    islands_free(&solver->parts);
    free(solver->arrays.memory);
    free(solver);
}

const ContactSolverKind solver_nncg = {
    .description = {.name = "nncg",
                    .summary = "nonsmooth nonlinear conjugate gradients over sweeps",
                    .caption = "conjugate gradients over sweeps",
                    .settings = settings,
                    .converges = "k=200",
                    .chart = METHOD_RUNS("k=5", "k=20", "k=50", "k=2,near=0.5,more=400", "k=5,near=0.02,more=10000",
                                         "k=5,near=0.0002,more=10000"),
                    .chart_quick = METHOD_RUNS("k=20", "k=1,near=0.02,more=10000"),
                    .stability_place = 5},
    .create = create,
    .solve = solve,
    .destroy = destroy};
