/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method admm: the settings of its equations (methods/admm_internal.h), the penalty, and when it ends. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/admm_internal.h"
#include "methods/methods.h"

#include <math.h>
#include <stdlib.h>

static const double share = 0.5, balance = 10, least_penalty = 1e-8;

/* Iterations end, too, where neither residual exceeds this share of the largest velocity: the answer is rounded to
   float, by 2^-24, and rows of masses a million times apart are scaled by roots 2^10 apart. */
static const double rounding = 0x1p-34;

static const SettingSpec settings[] = {
    {"k", "iterations per step (default: the scene's, else 10)", SETTING_INT(StoppingRule, k, 1, SWEEPS_MAX)},
    STOPPING_SETTINGS("iterations"),
    {0}};

static void *create(const Settings *chosen, Error *error) {
    static const Admm standard = {.rule.k = 10};
    return stopping_make(chosen, settings, &standard, sizeof standard, "admm", error);
}

static void destroy(void *state) {
    Admm *admm = state;
    if (admm == NULL) return;
    sweeps_free(&admm->sweeps);
    interior_free(&admm->interior);
    islands_free(&admm->islands);
    free(admm->memory.memory);
    free(admm);
}

/* The fastest that the processor supports. */
static const AdmmKernels *best_kernels(void) {
#ifdef TWINBOX_AVX
    if (sweeps_can(SWEEP_LANES)) return &admm_avx2;
#endif
    return &admm_scalar;
}

/* x^(1/20) of x > 1 by Newton's method, which falls from x^(1/16) to it. pow() would take 3% of a live page.
   With x the condition of the problem, the penalty begins with x^(4/20), and changes by x^(1/20). */
static double twentieth_root(double x) {
    double root = sqrt(sqrt(sqrt(sqrt(x))));
    for (double before = INFINITY; root < before;) {
        const double square = root * root, eighth = square * square * square * square;
        before = root;
        root -= (root - x / (eighth * eighth * square * root)) / 20;
    }
    return root;
}

static void iterate(Admm *admm) {
    const AdmmKernels *kernels = best_kernels();
    const StoppingRule *rule = &admm->rule;
    kernels->begin(admm);
    const double largest = kernels->largest(admm), condition = largest / admm_proximal;
    const double root = twentieth_root(condition);
    const double step = (double)(float)root; /* rounded, so that any way to it has the same bits */
    admm->penalty = share * sqrt(largest * admm_proximal) * (double)(float)(root * root * root * root);
    kernels->factorize(admm);
    for (int iterations = 1;; iterations++) {
        const int done = iterations - rule->k;
        kernels->iterate(admm);
        const bool exact = !(fmax(admm->primal, admm->dual) > rounding * admm->largest_g);
        if (exact || (done >= 0 && done % STOPPING_BLOCK == 0)) {
            /* The answer: y, and the velocities that it makes. */
            for (int i = 0; i < admm->interior.group_count; i++) {
                const AdmmGroup *g = &admm->groups[i];
                admm->interior.groups[i].answer_normal = g->root_normal * g->y_normal;
                admm->interior.groups[i].answer_tangent = g->root_tangent * g->y_tangent;
            }
            admm->interior.residual = interior_best()->answer(&admm->interior);
            if (exact || done >= rule->more || !(admm->interior.residual >= (double)rule->near)) return;
        }
        /* The spectral rule. */
        const bool larger = admm->primal > balance * admm->dual, smaller = admm->dual > balance * admm->primal;
        if (!larger && !smaller) continue;
        admm->penalty = fmax(larger ? admm->penalty * step : admm->penalty / step, least_penalty);
        kernels->factorize(admm);
    }
}

static bool solve_island(Admm *admm, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    static const SequentialOptions options = {.accumulate = true, .warm = true};
    if (!sweeps_begin(&admm->sweeps, sweeps_best_kernel(), problem, true) ||
        !interior_load(&admm->interior, interior_best(), &admm->sweeps, problem) ||
        !ARRAY_BLOCK_RESERVE(&admm->memory, ARRAY_PART(admm->groups, admm->interior.group_count)))
        return error_memory(error, "admm");
    iterate(admm);
    if (interior_end(&admm->interior, &admm->sweeps, problem, solution)) return true;
    sequential_impulses_solve(problem, &options, admm->rule.k, solution);
    solution->fallbacks.by_sweeps = 1;
    return true;
}

static bool solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    Admm *admm = state;
    if (!islands_find(&admm->islands, problem)) return error_memory(error, "admm");
    contact_solution_begin(problem, solution);
    for (int k = 0; k < admm->islands.count; k++) {
        ContactSolution of_part;
        const ContactProblem part = islands_take(&admm->islands, problem, k, &of_part);
        if (!solve_island(admm, &part, &of_part, error)) return false;
        islands_put(&admm->islands, k, &part, &of_part, solution);
    }
    solution->fallbacks.by_sweeps = solution->fallbacks.by_sweeps > 0;
    return islands_take_gain(&admm->islands, problem, solution) || error_memory(error, "admm");
}

const ContactSolverKind solver_admm = {
    .description = {.name = "admm",
                    .summary = "proximal ADMM: a factorization over the bodies, then many solutions with it",
                    .caption = "proximal ADMM",
                    .settings = settings,
                    .converges = "k=400",
                    .falls_back = true,
                    .chart = METHOD_RUNS("k=5", "k=20", "k=50", "k=100", "k=2,near=0.1,more=400",
                                         "k=1,near=0.5,more=10000", "k=2,near=0.5,more=10000",
                                         "k=1,near=0.02,more=10000", "k=1,near=0.0002,more=10000"),
                    .chart_quick = METHOD_RUNS("k=20", "k=2,near=0.02,more=400"),
                    .stability = METHOD_RUNS("", "k=50")},
    .create = create,
    .solve = solve,
    .destroy = destroy};
