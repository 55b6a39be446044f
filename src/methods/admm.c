/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method admm: the settings of its equations (methods/admm_internal.h), the penalty, and when it ends. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/admm_internal.h"
#include "methods/methods.h"

#include <math.h>
#include <stdlib.h>

static const double start_power = 0.2, step_power = 0.05, share = 0.5, balance = 10, least_penalty = 1e-8;

static const SettingSpec settings[] = {
    {"k", "iterations per step (default: the scene's, else 10)", SETTING_INT(StoppingRule, k, 1, SWEEPS_MAX)},
    STOPPING_SETTINGS("iterations"),
    {0}};

static void *admm_create(const Settings *chosen, Error *error) {
    static const Admm standard = {.rule.k = 10};
    return stopping_make(chosen, settings, &standard, sizeof standard, "admm", error);
}

static void admm_destroy(void *state) {
    Admm *admm = state;
    if (admm == NULL) return;
    sweeps_free(&admm->sweeps);
    interior_free(&admm->interior);
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

/* Rounded to float: maths libraries differ in the last bits of a double. */
static double rounded_power(double x, double power) { return (double)(float)pow(x, power); }

/* The penalty at first, and the factor by which it changes. */
typedef struct Spectrum {
    double penalty, step;
} Spectrum;

static Spectrum admm_look(Admm *admm, const AdmmKernels *kernels) {
    const double largest = kernels->largest(admm), condition = largest / admm_proximal;
    return (Spectrum){share * sqrt(largest * admm_proximal) * rounded_power(condition, start_power),
                      rounded_power(condition, step_power)};
}

/* The spectral rule. */
static void adapt(Admm *admm, const AdmmKernels *kernels, double step) {
    const bool larger = admm->primal > balance * admm->dual, smaller = admm->dual > balance * admm->primal;
    if (!larger && !smaller) return;
    admm->penalty = fmax(larger ? admm->penalty * step : admm->penalty / step, least_penalty);
    kernels->factorize(admm);
}

/* The answer: y, and the velocities that it makes. Sets its residual. */
static void take_answer(Admm *admm) {
    for (int i = 0; i < admm->interior.group_count; i++) {
        const AdmmGroup *g = &admm->groups[i];
        admm->interior.groups[i].answer_normal = g->root_normal * g->y_normal;
        admm->interior.groups[i].answer_tangent = g->root_tangent * g->y_tangent;
    }
    admm->interior.residual = interior_best()->answer(&admm->interior);
}

/* True after that many iterations if none follows; the answer is then taken. */
static bool is_last(Admm *admm, int iterations) {
    const StoppingRule *rule = &admm->rule;
    const int done = iterations - rule->k;
    if (done < 0 || done % STOPPING_BLOCK != 0) return false;
    take_answer(admm);
    return done >= rule->more || !(admm->interior.residual >= (double)rule->near);
}

static bool admm_load(Admm *admm, const ContactProblem *problem) {
    Interior *s = &admm->interior;
    return sweeps_begin(&admm->sweeps, sweeps_best_kernel(), problem, true) &&
           interior_load(s, interior_best(), &admm->sweeps, problem) &&
           ARRAY_BLOCK_RESERVE(&admm->memory, ARRAY_PART(admm->groups, s->group_count));
}

static void admm_iterate(Admm *admm) {
    const AdmmKernels *kernels = best_kernels();
    kernels->begin(admm);
    const Spectrum first = admm_look(admm, kernels);
    admm->penalty = first.penalty;
    kernels->factorize(admm);
    for (int iterations = 1;; iterations++) {
        kernels->iterate(admm);
        if (is_last(admm, iterations)) return;
        adapt(admm, kernels, first.step);
    }
}

static bool admm_solve(void *state, const ContactProblem *problem, ContactSolution *solution, Error *error) {
    static const SequentialOptions options = {.accumulate = true, .warm = true};
    Admm *admm = state;
    if (!admm_load(admm, problem)) return error_memory(error, "admm");
    admm_iterate(admm);
    if (interior_end(&admm->interior, &admm->sweeps, problem, solution)) return true;
    sequential_impulses_solve(problem, &options, admm->rule.k, solution);
    solution->fallbacks.by_sweeps = 1;
    return true;
}

const ContactSolverKind solver_admm = {
    .description = {.name = "admm",
                    .summary = "proximal ADMM: a factorization over the bodies, then many solutions with it",
                    .caption = "proximal ADMM",
                    .settings = settings,
                    .converges = "k=400",
                    .falls_back = true,
                    .chart = METHOD_RUNS("k=5", "k=10", "k=20", "k=50", "k=100", "k=2,near=0.1,more=400",
                                         "k=2,near=0.02,more=400", "k=2,near=0.005,more=400", "k=1,near=0.5,more=10000",
                                         "k=2,near=0.0002,more=10000"),
                    .chart_quick = METHOD_RUNS("k=20", "k=2,near=0.02,more=400"),
                    .stability = METHOD_RUNS("", "k=50")},
    .create = admm_create,
    .solve = admm_solve,
    .destroy = admm_destroy};
