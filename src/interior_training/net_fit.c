/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_training/net_fit.h"

#include "common/array.h"
#include "common/split_mix.h"
#include "learning/adam.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>

enum { BATCH = 64 };

/* The residual decides after which iteration a solve stops, so the answers of all but the first count. The logarithm
   follows the median; the tail term follows the mean, which a few hits dominate. */
static const InteriorTask task = {.first = 2, .last = 7, .floor = 0.003, .tail = 0.5};
static const double square_decay = 0.99; /* of Adam */
/* The slopes of one problem are limited, as an iteration can amplify them without bound. */
static const double slope_max = 2;
static const double error_max = 1e3; /* m/s: what a failed solve counts */

void net_fit_free(NetFit *fit) {
    for (int i = 0; fit->unrolled != NULL && i < fit->threads; i++) unrolled_interior_free(&fit->unrolled[i]);
    free(fit->unrolled);
    free(fit->slopes);
    free(fit->losses);
    free(fit->order);
    *fit = (NetFit){0};
}

bool net_fit_begin(NetFit *fit, Error *error) {
    fit->threads = omp_get_max_threads();
    fit->unrolled = calloc((size_t)fit->threads, sizeof *fit->unrolled);
    fit->slopes = calloc((size_t)BATCH * INTERIOR_NET_WEIGHTS, sizeof *fit->slopes);
    fit->losses = calloc(BATCH, sizeof *fit->losses);
    return (fit->unrolled != NULL && fit->slopes != NULL && fit->losses != NULL) || error_memory(error, "interior-net");
}

/* Fisher and Yates. */
static void shuffle(int *order, int count, uint64_t seed) {
    for (int i = 0; i < count; i++) order[i] = i;
    for (int i = count - 1; i > 0; i--) {
        const int j = (int)(split_mix(&seed) % (uint64_t)(i + 1)), kept = order[i];
        order[i] = order[j];
        order[j] = kept;
    }
}

/* Zero where they are NaN or infinite. */
static void limit_slopes(double *slopes) {
    double sum = 0;
    for (int i = 0; i < INTERIOR_NET_WEIGHTS; i++) sum += slopes[i] * slopes[i];
    const double length = sqrt(sum), by = !isfinite(length) ? 0 : length > slope_max ? slope_max / length : 1;
    for (int i = 0; i < INTERIOR_NET_WEIGHTS; i++) slopes[i] = by > 0 ? slopes[i] * by : 0;
}

static bool do_batch(NetFit *fit, const double *weights, const ImpactProblems *problems, const int *items, int count) {
    bool ok = true;
    memset(fit->slopes, 0, (size_t)BATCH * INTERIOR_NET_WEIGHTS * sizeof *fit->slopes);
#pragma omp parallel for schedule(dynamic, 1) reduction(&& : ok) num_threads(fit->threads)
    for (int i = 0; i < count; i++) {
        const ImpactProblem *item = &problems->items[items[i]];
        double *slopes = fit->slopes + (ptrdiff_t)INTERIOR_NET_WEIGHTS * i;
        const bool done = unrolled_interior_loss(&fit->unrolled[omp_get_thread_num()], &item->problem, item->reference,
                                                 weights, &task, &fit->losses[i], slopes);
        limit_slopes(slopes);
        ok = ok && done;
    }
    return ok;
}

static void step(NetFit *fit, NetState *state, int count, double rate) {
    double *sum = fit->slopes;
    for (int i = 1; i < count; i++)
        for (int k = 0; k < INTERIOR_NET_WEIGHTS; k++) sum[k] += fit->slopes[(ptrdiff_t)INTERIOR_NET_WEIGHTS * i + k];
    for (int k = 0; k < INTERIOR_NET_WEIGHTS; k++) sum[k] /= count;
    Adam adam = adam_over(state->weights, state->mean, state->square, INTERIOR_NET_WEIGHTS, state->steps, square_decay);
    adam_step(&adam, sum, rate);
    state->steps++;
}

bool net_fit_epoch(NetFit *fit, NetState *state, const ImpactProblems *problems, uint64_t seed, double rate,
                   double last_rate, double *mean_loss, Error *error) {
    const int count = (int)problems->count, batches = (count + BATCH - 1) / BATCH;
    if (!array_reserve((void **)&fit->order, &fit->order_capacity, (size_t)count, sizeof *fit->order))
        return error_memory(error, "interior-net");
    shuffle(fit->order, count, seed);
    *mean_loss = 0;
    for (int b = 0; b < batches; b++) {
        const int size = count - b * BATCH < BATCH ? count - b * BATCH : BATCH;
        if (!do_batch(fit, state->weights, problems, fit->order + (ptrdiff_t)b * BATCH, size))
            return error_memory(error, "interior-net");
        for (int i = 0; i < size; i++) *mean_loss += isfinite(fit->losses[i]) ? fit->losses[i] / count : 0;
        step(fit, state, size, rate + (last_rate - rate) * b / batches);
    }
    return true;
}

static int compare(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static bool solve_all(NetFit *fit, const double *weights, const ImpactProblems *problems, double *errors) {
    static const InteriorTask all = {.first = 1, .last = UNROLLED_ITERATIONS_MAX, .floor = 1};
    const int count = (int)problems->count;
    bool ok = true;
#pragma omp parallel for schedule(dynamic, 8) reduction(&& : ok) num_threads(fit->threads)
    for (int i = 0; i < count; i++) {
        const ImpactProblem *item = &problems->items[i];
        UnrolledInterior *unrolled = &fit->unrolled[omp_get_thread_num()];
        double loss;
        const bool done = unrolled_interior_loss(unrolled, &item->problem, item->reference, weights, &all, &loss, NULL);
        ok = ok && done;
        for (int k = 0; k < UNROLLED_ITERATIONS_MAX; k++) {
            const double found = unrolled->errors[k];
            errors[(ptrdiff_t)k * count + i] = found < error_max ? found : error_max;
        }
    }
    return ok;
}

bool net_fit_errors(NetFit *fit, const double *weights, const ImpactProblems *problems, NetErrors *errors,
                    Error *error) {
    const int count = (int)problems->count;
    double *all = calloc((size_t)count * UNROLLED_ITERATIONS_MAX, sizeof *all);
    const bool ok = (all != NULL && solve_all(fit, weights, problems, all)) || error_memory(error, "interior-net");
    for (int k = 0; ok && k < UNROLLED_ITERATIONS_MAX; k++) {
        double *of = all + (ptrdiff_t)k * count;
        errors->mean[k] = 0;
        for (int i = 0; i < count; i++) errors->mean[k] += of[i] / count;
        qsort(of, (size_t)count, sizeof *of, compare);
        errors->percentile95[k] = of[(count - 1) * 95 / 100];
    }
    free(all);
    return ok;
}
