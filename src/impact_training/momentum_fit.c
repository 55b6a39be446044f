/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact_training/momentum_fit.h"

#include "impact_training/cma_es.h"
#include "impact_training/impact_problems.h"
#include "reference/solution_error.h"
#include "solvers/momentum.h"

#include <omp.h>
#include <stdlib.h>

enum { KNOTS_MAX = 20 };

static const int fitted[] = {5, 10, 20, 50};
enum { FITTED = sizeof fitted / sizeof fitted[0], SWEEPS_SUM = 5 + 10 + 20 + 50, SWEEPS_MOST = 50 };

/* Work space of a thread. */
typedef struct Worker {
    Momentum momentum;
    ContactSolution solution;
} Worker;

typedef struct Fit {
    ImpactProblems problems;
    double *errors; /* [problems.count] */
    Worker *workers;
    int worker_count;
    int sweeps, knots; /* of the current schedule */
} Fit;

static void fit_end(Fit *fit) {
    for (int i = 0; fit->workers != NULL && i < fit->worker_count; i++) {
        momentum_free(&fit->workers[i].momentum);
        free(fit->workers[i].solution.velocities);
        free(fit->workers[i].solution.impulses);
    }
    free(fit->workers);
    free(fit->errors);
    impact_problems_free(&fit->problems);
}

static bool fit_begin(Fit *fit, Error *error) {
    size_t bodies = 1, contacts = 1;
    for (size_t i = 0; i < fit->problems.count; i++) {
        const ContactProblem *problem = &fit->problems.items[i].problem;
        if (bodies < (size_t)problem->body_count) bodies = (size_t)problem->body_count;
        if (contacts < (size_t)problem->contact_count) contacts = (size_t)problem->contact_count;
    }
    fit->worker_count = omp_get_max_threads();
    fit->errors = calloc(fit->problems.count, sizeof *fit->errors);
    fit->workers = calloc((size_t)fit->worker_count, sizeof *fit->workers);
    bool ok = fit->errors != NULL && fit->workers != NULL;
    for (int i = 0; ok && i < fit->worker_count; i++) {
        ContactSolution *solution = &fit->workers[i].solution;
        solution->velocities = calloc(bodies, sizeof *solution->velocities);
        solution->impulses = calloc(contacts, sizeof *solution->impulses);
        ok = solution->velocities != NULL && solution->impulses != NULL;
    }
    return ok || error_memory(error, "momentum schedules");
}

/* Mean error of the impact frames plus that of the frames after. A failed solve (out of memory) counts as 1e9. */
static double mean_error(Fit *fit, const float *factors) {
    const int count = (int)fit->problems.count;
#pragma omp parallel for schedule(dynamic, 16)
    for (int i = 0; i < count; i++) {
        Worker *worker = &fit->workers[omp_get_thread_num()];
        const ImpactProblem *item = &fit->problems.items[i];
        Error error;
        bool ok = momentum_solve(&worker->momentum, &item->problem, factors, fit->sweeps, &worker->solution, &error);
        fit->errors[i] = ok ? solution_error(&item->problem, worker->solution.velocities, item->reference).rms : 1e9;
    }
    double sums[2] = {0, 0}, counts[2] = {0, 0};
    for (int i = 0; i < count; i++) {
        sums[fit->problems.items[i].impact] += fit->errors[i];
        counts[fit->problems.items[i].impact]++;
    }
    return (counts[0] > 0 ? sums[0] / counts[0] : 0) + (counts[1] > 0 ? sums[1] / counts[1] : 0);
}

/* Factors of the sweeps 1, 2, ... by linear interpolation of the knots, clamped to their bounds. Returns the sum of the
   squared excesses. */
static double factors_of(const Fit *fit, const double *knots, float *factors) {
    double out = 0;
    factors[0] = 0;
    for (int s = 1; s < fit->sweeps; s++) {
        double at = fit->sweeps > 2 ? (double)(s - 1) / (fit->sweeps - 2) * (fit->knots - 1) : 0;
        int left = (int)at < fit->knots - 2 ? (int)at : fit->knots - 2;
        double value = knots[left] + (at - left) * (knots[left + 1] - knots[left]);
        double inside = value < 0 ? 0 : value > (double)MOMENTUM_MAX_FACTOR ? (double)MOMENTUM_MAX_FACTOR : value;
        out += (value - inside) * (value - inside);
        factors[s] = (float)inside;
    }
    return out;
}

static double cost(void *context, const double *knots) {
    float factors[SWEEPS_MOST];
    double out = factors_of(context, knots, factors);
    return mean_error(context, factors) + out;
}

/* Fits one schedule and appends it. */
static bool fit_schedule(Fit *fit, MomentumSchedules *schedules, const MomentumFitOptions *options,
                         const Progress *progress, Error *error) {
    fit->knots = fit->sweeps - 1 < KNOTS_MAX ? fit->sweeps - 1 : KNOTS_MAX;
    double knots[KNOTS_MAX];
    for (int i = 0; i < fit->knots; i++) {
        int sweep = 1 + (fit->sweeps - 2) * i / (fit->knots - 1);
        knots[i] = (double)momentum_factor_tuned(sweep, fit->sweeps);
    }
    const CmaEs task = {fit->knots, 0.15, options->generations, options->seed, cost, fit};
    if (!cma_es_minimize(&task, knots, progress, error)) return false;
    float factors[SWEEPS_MOST], hand_tuned[SWEEPS_MOST], none[SWEEPS_MOST] = {0};
    factors_of(fit, knots, factors);
    for (int s = 0; s < fit->sweeps; s++) hand_tuned[s] = momentum_factor_tuned(s, fit->sweeps);
    double learned_error = mean_error(fit, factors), hand_tuned_error = mean_error(fit, hand_tuned);
    /* The interpolated factors cannot represent all hand-tuned ones, so they can be worse. */
    bool better = learned_error < hand_tuned_error;
    if (options->on_schedule != NULL)
        options->on_schedule(options->context, fit->sweeps, mean_error(fit, none), hand_tuned_error,
                             better ? learned_error : hand_tuned_error);
    return momentum_schedules_add(schedules, fit->sweeps, better ? factors : hand_tuned, error);
}

bool momentum_fit(MomentumSchedules *schedules, const Scene *scene, const MomentumFitOptions *options,
                  const Progress *progress, Error *error) {
    *schedules = (MomentumSchedules){0};
    Fit fit = {0};
    ProgressStage stage = {.whole = progress, .share = 0.5};
    const Progress within = {progress_stage, &stage};
    bool ok = impact_problems_record(&fit.problems, scene, &options->bomb_x, &within, error) && fit_begin(&fit, error);
    for (int i = 0; ok && i < FITTED; i++) {
        stage.begin += stage.share;
        stage.share = 0.5 * fitted[i] / SWEEPS_SUM;
        fit.sweeps = fitted[i];
        ok = fit_schedule(&fit, schedules, options, &within, error);
    }
    fit_end(&fit);
    if (!ok) momentum_schedules_free(schedules);
    return ok;
}
