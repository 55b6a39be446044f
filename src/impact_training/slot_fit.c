/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact_training/slot_fit.h"

#include "learning/adam.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* A batch has a fixed number of parts, so that the order of sums does not depend on the number of threads. */
enum { BATCH = 32, PARTS = 4, PART = BATCH / PARTS };

typedef struct Fitter {
    SlotNetwork *network;
    const SlotSamples *samples;
    const SlotFit *fit;
    float *gradients;     /* [PARTS, parameter_count] */
    float *mean, *square; /* [parameter_count] moments of Adam; in double they would need twice the memory */
    double factors[SLOT_SWEEPS_MAX], factor_mean[SLOT_SWEEPS_MAX], factor_square[SLOT_SWEEPS_MAX];
    double by_factors[PARTS][SLOT_SWEEPS_MAX], losses[PARTS];
    SlotLoss loss[PARTS];
    Adam adam;  /* of the factors; its steps are those of all parameters */
    int *order; /* [samples] */
} Fitter;

static SlotTask task_of(const Fitter *fitter, int epoch) {
    const bool impulses_only = epoch < fitter->fit->impulse_epochs;
    return (SlotTask){impulses_only ? 1 : fitter->fit->impulse_weight, impulses_only ? 0 : 1, fitter->network->sweeps,
                      fitter->factors};
}

static bool do_part(Fitter *fitter, const SlotTask *task, const int *items, int count, int part) {
    float *gradient = fitter->gradients + (size_t)part * fitter->network->parameter_count;
    double *by_factors = fitter->fit->learn_factors && task->velocity_weight > 0 ? fitter->by_factors[part] : NULL;
    for (int i = 0; i < count; i++) {
        SlotScore score;
        if (!slot_loss(&fitter->loss[part], fitter->network, &fitter->samples->items[items[i]], task, gradient,
                       by_factors, &score))
            return false;
        fitter->losses[part] += score.loss;
    }
    return true;
}

/* The gradients of a batch, one per part. */
static bool do_batch(Fitter *fitter, const SlotTask *task, const int *items, int count) {
    bool ok = true;
#pragma omp parallel for schedule(static, 1) reduction(&& : ok)
    for (int part = 0; part < PARTS; part++) {
        const int begin = part * PART < count ? part * PART : count, end = begin + PART < count ? begin + PART : count;
        bool done = do_part(fitter, task, items + begin, end - begin, part);
        ok = ok && done;
    }
    return ok;
}

static void step_parameters(Fitter *fitter, int count, const AdamStep *step) {
    const int64_t parameters = (int64_t)fitter->network->parameter_count;
#pragma omp parallel for schedule(static)
    for (int64_t p = 0; p < parameters; p++) {
        float sum = 0;
        for (int part = 0; part < PARTS; part++) {
            sum += fitter->gradients[part * parameters + p];
            fitter->gradients[part * parameters + p] = 0;
        }
        double mean = (double)fitter->mean[p], square = (double)fitter->square[p];
        fitter->network->parameters[p] -= (float)adam_change(step, (double)sum / count, &mean, &square);
        fitter->mean[p] = (float)mean;
        fitter->square[p] = (float)square;
    }
    slot_network_pack_layers(fitter->network);
}

/* Factors are clamped to 0 .. 2: extrapolating further than two sweeps gains nothing. */
static void step_factors(Fitter *fitter, int count, const AdamStep *step) {
    for (int s = 1; s < fitter->network->sweeps; s++) {
        double sum = 0;
        for (int part = 0; part < PARTS; part++) {
            sum += fitter->by_factors[part][s];
            fitter->by_factors[part][s] = 0;
        }
        fitter->factors[s] -= adam_change(step, sum / count, &fitter->adam.mean[s], &fitter->adam.square[s]);
        fitter->factors[s] = fmin(fmax(fitter->factors[s], 0), 2);
    }
}

static bool do_epoch(Fitter *fitter, int epoch, double *mean_loss) {
    const SlotTask task = task_of(fitter, epoch);
    const int count = fitter->samples->count, batches = (count + BATCH - 1) / BATCH;
    memset(fitter->losses, 0, sizeof fitter->losses);
    for (int batch = 0; batch < batches; batch++) {
        const int first = batch * BATCH, size = count - first < BATCH ? count - first : BATCH;
        if (!do_batch(fitter, &task, fitter->order + first, size)) return false;
        const double done = (epoch + (double)batch / batches) / fitter->fit->epochs;
        const AdamStep step = adam_next(&fitter->adam, fitter->fit->rate * adam_cosine(done));
        step_parameters(fitter, size, &step);
        if (fitter->fit->learn_factors && task.velocity_weight > 0) step_factors(fitter, size, &step);
    }
    *mean_loss = 0;
    for (int part = 0; part < PARTS; part++) *mean_loss += fitter->losses[part] / count;
    return true;
}

static bool begin(Fitter *fitter) {
    const size_t parameters = fitter->network->parameter_count;
    fitter->gradients = calloc((PARTS + 2) * parameters, sizeof *fitter->gradients);
    fitter->order = malloc(((size_t)fitter->samples->count + 1) * sizeof *fitter->order);
    if (fitter->gradients == NULL || fitter->order == NULL) return false;
    fitter->mean = fitter->gradients + PARTS * parameters;
    fitter->square = fitter->mean + parameters;
    for (int s = 0; s < fitter->network->sweeps; s++) fitter->factors[s] = (double)fitter->network->factors[s];
    fitter->adam = adam_over(fitter->factors, fitter->factor_mean, fitter->factor_square, fitter->network->sweeps, 0,
                             ADAM_SQUARE_DECAY);
    for (int i = 0; i < fitter->samples->count; i++) fitter->order[i] = i;
    return true;
}

static bool run(Fitter *fitter, gsl_rng *generator, const Progress *progress, Error *error) {
    for (int epoch = 0; epoch < fitter->fit->epochs; epoch++) {
        double loss;
        gsl_ran_shuffle(generator, fitter->order, (size_t)fitter->samples->count, sizeof *fitter->order);
        if (!do_epoch(fitter, epoch, &loss)) return error_memory(error, "scene-net");
        if (!isfinite(loss)) return error_input(error, "scene-net", "training diverged in epoch %d", epoch + 1);
        if (!progress_report(progress, epoch + 1, fitter->fit->epochs)) break;
    }
    for (int s = 0; s < fitter->network->sweeps; s++) fitter->network->factors[s] = (float)fitter->factors[s];
    return true;
}

bool slot_fit(SlotNetwork *network, const SlotSamples *samples, const SlotFit *fit, const Progress *progress,
              Error *error) {
    Fitter *fitter = calloc(1, sizeof *fitter);
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    bool ok = fitter != NULL && generator != NULL;
    if (ok) {
        gsl_rng_set(generator, (unsigned long)fit->seed);
        fitter->network = network;
        fitter->samples = samples;
        fitter->fit = fit;
        ok = begin(fitter);
    }
    ok = ok ? run(fitter, generator, progress, error) : error_memory(error, "scene-net");
    for (int part = 0; fitter != NULL && part < PARTS; part++) slot_loss_free(&fitter->loss[part]);
    if (fitter != NULL) {
        free(fitter->gradients);
        free(fitter->order);
    }
    free(fitter);
    if (generator != NULL) gsl_rng_free(generator);
    return ok;
}

bool slot_errors(const SlotNetwork *network, const SlotSamples *samples, int first, double *errors, Error *error) {
    double factors[SLOT_SWEEPS_MAX];
    for (int s = 0; s < network->sweeps; s++) factors[s] = (double)network->factors[s];
    const SlotTask task = {0, 1, network->sweeps, factors};
    SlotLoss *losses = calloc((size_t)omp_get_max_threads(), sizeof *losses);
    bool ok = losses != NULL;
#pragma omp parallel for schedule(dynamic, 16) reduction(&& : ok)
    for (int i = first; i < samples->count; i++) {
        SlotScore score = {0};
        bool fine = losses != NULL &&
                    slot_loss(&losses[omp_get_thread_num()], network, &samples->items[i], &task, NULL, NULL, &score);
        errors[i - first] = score.error;
        ok = ok && fine;
    }
    for (int i = 0; losses != NULL && i < omp_get_max_threads(); i++) slot_loss_free(&losses[i]);
    free(losses);
    return ok || error_memory(error, "scene-net");
}
