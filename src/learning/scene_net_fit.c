/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fits the network of scene-net: samples, the loss of one, mini-batches. */
#include "learning/scene_net_fit.h"

#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "learning/launches.h"
#include "learning/learning.h"
#include "methods/reference.h"
#include "methods/sweeps.h"
#include "nets/kernels.h"
#include "nets/kinds.h"

#include <gsl/gsl_randist.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

void scene_net_samples_free(SceneNetSamples *samples) {
    for (int i = 0; i < samples->count; i++) {
        SceneNetSample *sample = &samples->items[i];
        problem_copy_free(&sample->step.problem);
        free(sample->step.velocities);
        unrolled_problem_free(&sample->unrolled);
        scene_view_free(&sample->view);
        free(sample->inputs);
    }
    free(samples->items);
    *samples = (SceneNetSamples){0};
}

bool scene_net_samples_take(SceneNetSamples *samples, RecordedSteps *steps) {
    if (!array_reserve((void **)&samples->items, &samples->capacity, (size_t)samples->count + steps->count + 1,
                       sizeof *samples->items))
        return false;
    for (size_t i = 0; i < steps->count; i++)
        samples->items[samples->count++] = (SceneNetSample){.step = steps->items[i]};
    samples->unconverged += steps->unconverged;
    steps->count = steps->unconverged = 0;
    return true;
}

bool scene_net_samples_look(SceneNetSamples *samples, int first, const SceneNet *network, Error *error) {
    bool ok = true;
#pragma omp parallel for schedule(dynamic, 64) reduction(&& : ok)
    for (int i = first; i < samples->count; i++) {
        SceneNetSample *sample = &samples->items[i];
        if (sample->inputs == NULL) sample->inputs = malloc((size_t)scene_net_inputs(network) * sizeof *sample->inputs);
        const bool fine =
            sample->inputs != NULL &&
            (sample->unrolled.contacts != NULL || unrolled_problem_make(&sample->unrolled, &sample->step.problem)) &&
            scene_view_take(&sample->view, network, &sample->step.problem);
        if (fine) scene_net_look(network, &sample->view.slots, sample->inputs);
        ok = ok && fine;
    }
    return ok || error_memory(error, "samples");
}

/* Inputs of new launches exceed those of the training by a little. */
void scene_net_set_ranges(SceneNet *network, const SceneNetSamples *samples) {
    const float margin = 0.1f;
    for (int k = 0; k < scene_net_inputs(network); k++) {
        float low = samples->items[0].inputs[k], high = low;
        for (int i = 1; i < samples->count; i++) {
            low = fminf(low, samples->items[i].inputs[k]);
            high = fmaxf(high, samples->items[i].inputs[k]);
        }
        network->low[k] = low - margin * (high - low) - 1e-6f;
        network->high[k] = high + margin * (high - low) + 1e-6f;
    }
}

static const double linear_from = 0.3;  /* threshold of smooth L1, in scales */
static const double least_error = 0.01; /* m/s: below it the loss is nearly quadratic */

void scene_net_loss_free(SceneNetLoss *loss) {
    unrolled_free(&loss->unrolled);
    free(loss->outputs);
    free(loss->by_outputs);
    free(loss->numbers);
    *loss = (SceneNetLoss){0};
}

/* Smooth L1 and its derivative. */
static double smooth(double x, double *by) {
    const double size = fabs(x);
    *by = size < linear_from ? x / linear_from : copysign(1, x);
    return size < linear_from ? x * x / (2 * linear_from) : size - linear_from / 2;
}

/* Returns the impulse loss; writes its derivative with respect to the outputs. */
static double impulse_loss(const SceneNet *network, const SceneNetSample *sample, const double *start, double weight,
                           float *by_outputs) {
    const SceneNetView *slots = &sample->view.slots;
    double sum = 0;
    for (int i = 0; i < slots->slot_count; i++) {
        const int contact = sample->view.contacts[i];
        const double scale = (double)network->scale[slots->slots[i]], share = weight / slots->slot_count;
        const double goal[2] = {(double)sample->step.impulses[contact].normal,
                                (double)sample->step.impulses[contact].tangent};
        for (int k = 0; k < 2; k++) {
            double by;
            sum += share * smooth((start[2 * contact + k] - goal[k]) / scale, &by);
            by_outputs[2 * i + k] = (float)(share * by / scale);
        }
    }
    return sum;
}

/* Adds the velocity loss to the score and, if `back`, its derivative to loss->by_outputs. The error is that of
   solution_error(). */
static bool velocity_loss(SceneNetLoss *loss, const SceneNetSample *sample, const SceneNetTask *task, bool back,
                          double *by_factors, SceneNetErrors *score) {
    const SceneNetView *slots = &sample->view.slots;
    const ContactProblem *problem = &sample->step.problem;
    double *start = loss->numbers, *by_start = start + 2 * problem->contact_count,
           *by_velocity = by_start + 2 * problem->contact_count, sum = 0;
    if (!unrolled_run(&loss->unrolled, &sample->unrolled, start, task->factors, task->sweeps)) return false;
    int counted = 0;
    for (int i = 0; i < problem->body_count; i++) {
        const ReferenceVelocity *goal = &sample->step.velocities[i];
        const double *velocity = loss->unrolled.velocities + 3 * i;
        double *by = by_velocity + 3 * i; /* half the derivative of the squared error */
        by[0] = velocity[0] - goal->x;
        by[1] = velocity[1] - goal->y;
        by[2] = (velocity[2] - goal->spin) / 6;
        if (!(problem->bodies[i].inv_mass > 0)) by[0] = by[1] = by[2] = 0;
        counted += problem->bodies[i].inv_mass > 0;
        sum += by[0] * by[0] + by[1] * by[1] + 6 * by[2] * by[2];
    }
    score->error = counted > 0 ? sqrt(sum / counted) : 0;
    const double root = sqrt(score->error * score->error + least_error * least_error);
    score->loss += task->velocity_weight * root;
    if (!back) return true;
    for (int i = 0; i < 3 * problem->body_count; i++) by_velocity[i] *= task->velocity_weight / (counted * root);
    unrolled_back(&loss->unrolled, &sample->unrolled, by_velocity, by_start, by_factors);
    for (int i = 0; i < slots->slot_count; i++)
        for (int k = 0; k < 2; k++) loss->by_outputs[2 * i + k] += (float)by_start[2 * sample->view.contacts[i] + k];
    return true;
}

/* The gradient entry of a parameter. */
static float *place(const SceneNet *network, float *gradient, const float *parameter) {
    return gradient + (parameter - network->parameters);
}

static void back_through_layer(const SceneNet *network, const SceneNetLayer *layer, const float *in, const float *out,
                               float *by_out, float *by_in, float *gradient) {
    const RowKernels *kernels = network->kernels;
    float *biases = place(network, gradient, layer->biases);
    for (int j = 0; j < layer->to; j++) by_out[j] *= 1 - out[j] * out[j];
    for (int j = 0; j < layer->to; j++) biases[j] += by_out[j];
    kernels->spread(place(network, gradient, layer->rows), layer->to, NULL, in, by_out, layer->from);
    if (by_in != NULL) kernels->multiply(by_in, &layer->packed, NULL, by_out, layer->from / 2);
}

static void back(SceneNetLoss *loss, const SceneNet *network, const SceneNetSample *sample, float *gradient) {
    const SceneNetView *slots = &sample->view.slots;
    const RowKernels *kernels = network->kernels;
    const int hidden = scene_net_hidden(network), outputs = 2 * slots->slot_count;
    float *biases = place(network, gradient, network->biases), *by = loss->by_outputs;
    for (int i = 0; i < outputs; i++) {
        by[i] *= network->scale[slots->slots[i / 2]];
        biases[slots->impulses[i]] += by[i];
    }
    memset(loss->by_second, 0, sizeof loss->by_second);
    kernels->add(loss->by_second, &network->packed, slots->impulses, by, outputs);
    kernels->spread(place(network, gradient, network->rows), hidden, slots->impulses, by, loss->second, outputs);
    back_through_layer(network, &network->second, loss->first, loss->second, loss->by_second, loss->by_first, gradient);
    back_through_layer(network, &network->first, sample->inputs, loss->first, loss->by_first, NULL, gradient);
}

bool scene_net_loss(SceneNetLoss *loss, const SceneNet *network, const SceneNetSample *sample, const SceneNetTask *task,
                    float *gradient, double *by_factors, SceneNetErrors *score) {
    const SceneNetView *slots = &sample->view.slots;
    const size_t contacts = (size_t)sample->step.problem.contact_count,
                 bodies = (size_t)sample->step.problem.body_count;
    if (!array_reserve((void **)&loss->outputs, &loss->output_capacity, 2 * contacts + 2, sizeof(float)) ||
        !array_reserve((void **)&loss->by_outputs, &loss->by_output_capacity, 2 * contacts + 2, sizeof(float)) ||
        !array_reserve((void **)&loss->numbers, &loss->number_capacity, 4 * contacts + 3 * bodies, sizeof(double)))
        return false;
    scene_net_predict(network, sample->inputs, slots, loss->first, loss->second, loss->outputs);
    double *start = loss->numbers;
    for (int i = 0; i < sample->step.problem.contact_count; i++) {
        start[2 * i] = (double)sample->view.base[i].normal;
        start[2 * i + 1] = (double)sample->view.base[i].tangent;
    }
    for (int i = 0; i < slots->slot_count; i++)
        for (int k = 0; k < 2; k++) start[2 * sample->view.contacts[i] + k] += (double)loss->outputs[2 * i + k];
    *score = (SceneNetErrors){.loss = impulse_loss(network, sample, start, task->impulse_weight, loss->by_outputs)};
    const bool run_sweeps = task->velocity_weight > 0 || gradient == NULL;
    if (run_sweeps && !velocity_loss(loss, sample, task, gradient != NULL, by_factors, score)) return false;
    if (gradient != NULL) back(loss, network, sample, gradient);
    return true;
}

/* A batch has a fixed number of parts, so that the order of sums does not depend on the number of threads. */
enum { BATCH = 32, PARTS = 4, PART = BATCH / PARTS };

typedef struct Fitter {
    SceneNet *network;
    const SceneNetSamples *samples;
    const SceneNetFit *fit;
    float *gradients;     /* [PARTS, parameter_count] */
    float *mean, *square; /* [parameter_count] moments of Adam; in double they would need twice the memory */
    double factors[SCENE_NET_SWEEPS_MAX], factor_mean[SCENE_NET_SWEEPS_MAX], factor_square[SCENE_NET_SWEEPS_MAX];
    double by_factors[PARTS][SCENE_NET_SWEEPS_MAX], losses[PARTS];
    SceneNetLoss loss[PARTS];
    Adam adam;  /* of the factors; its steps are those of all parameters */
    int *order; /* [samples] */
} Fitter;

/* The gradients of a batch, one per part. */
static bool do_batch(Fitter *fitter, const SceneNetTask *task, const int *items, int count) {
    bool ok = true;
#pragma omp parallel for schedule(static, 1) reduction(&& : ok)
    for (int part = 0; part < PARTS; part++) {
        const int begin = part * PART < count ? part * PART : count, end = begin + PART < count ? begin + PART : count;
        float *gradient = fitter->gradients + (size_t)part * fitter->network->parameter_count;
        double *by_factors = fitter->fit->learn_factors && task->velocity_weight > 0 ? fitter->by_factors[part] : NULL;
        bool done = true;
        for (int i = begin; done && i < end; i++) {
            SceneNetErrors score;
            done = scene_net_loss(&fitter->loss[part], fitter->network, &fitter->samples->items[items[i]], task,
                                  gradient, by_factors, &score);
            if (done) fitter->losses[part] += score.loss;
        }
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
    scene_net_pack_layers(fitter->network);
}

static bool do_epoch(Fitter *fitter, int epoch, double *mean_loss) {
    const bool impulses_only = epoch < fitter->fit->impulse_epochs;
    const SceneNetTask task = {impulses_only ? 1 : fitter->fit->impulse_weight, impulses_only ? 0 : 1,
                               fitter->network->sweeps, fitter->factors};
    const int count = fitter->samples->count, batches = (count + BATCH - 1) / BATCH;
    memset(fitter->losses, 0, sizeof fitter->losses);
    for (int batch = 0; batch < batches; batch++) {
        const int first = batch * BATCH, size = count - first < BATCH ? count - first : BATCH;
        if (!do_batch(fitter, &task, fitter->order + first, size)) return false;
        const double done = (epoch + (double)batch / batches) / fitter->fit->epochs;
        const AdamStep step = adam_next(&fitter->adam, fitter->fit->rate * adam_cosine(done));
        step_parameters(fitter, size, &step);
        /* Factors are clamped to 0 .. 2: extrapolating further than two sweeps gains nothing. */
        const bool learns = fitter->fit->learn_factors && task.velocity_weight > 0;
        for (int s = 1; learns && s < fitter->network->sweeps; s++) {
            double sum = 0;
            for (int part = 0; part < PARTS; part++) {
                sum += fitter->by_factors[part][s];
                fitter->by_factors[part][s] = 0;
            }
            fitter->factors[s] -= adam_change(&step, sum / size, &fitter->adam.mean[s], &fitter->adam.square[s]);
            fitter->factors[s] = fmin(fmax(fitter->factors[s], 0), 2);
        }
    }
    *mean_loss = 0;
    for (int part = 0; part < PARTS; part++) *mean_loss += fitter->losses[part] / count;
    return true;
}

bool scene_net_fit(SceneNet *network, const SceneNetSamples *samples, const SceneNetFit *fit, const Progress *progress,
                   Error *error) {
    const size_t parameters = network->parameter_count;
    Fitter *fitter = calloc(1, sizeof *fitter);
    gsl_rng *generator = gsl_rng_alloc(gsl_rng_mt19937);
    bool ok = fitter != NULL && generator != NULL;
    if (ok) {
        gsl_rng_set(generator, (unsigned long)fit->seed);
        *fitter = (Fitter){.network = network, .samples = samples, .fit = fit};
        fitter->gradients = calloc((PARTS + 2) * parameters, sizeof *fitter->gradients);
        fitter->order = malloc(((size_t)samples->count + 1) * sizeof *fitter->order);
        ok = fitter->gradients != NULL && fitter->order != NULL;
    }
    if (ok) {
        fitter->mean = fitter->gradients + PARTS * parameters;
        fitter->square = fitter->mean + parameters;
        for (int s = 0; s < network->sweeps; s++) fitter->factors[s] = (double)network->factors[s];
        fitter->adam = adam_over(fitter->factors, fitter->factor_mean, fitter->factor_square, network->sweeps);
        for (int i = 0; i < samples->count; i++) fitter->order[i] = i;
    }
    if (!ok) error_memory(error, "scene-net");
    for (int epoch = 0; ok && epoch < fit->epochs; epoch++) {
        double loss;
        gsl_ran_shuffle(generator, fitter->order, (size_t)samples->count, sizeof *fitter->order);
        ok = do_epoch(fitter, epoch, &loss) || error_memory(error, "scene-net");
        if (ok && !isfinite(loss)) ok = error_input(error, "scene-net", "training diverged in epoch %d", epoch + 1);
        if (ok && !progress_report(progress, epoch + 1, fit->epochs)) break;
    }
    for (int s = 0; ok && s < network->sweeps; s++) network->factors[s] = (float)fitter->factors[s];
    for (int part = 0; fitter != NULL && part < PARTS; part++) scene_net_loss_free(&fitter->loss[part]);
    if (fitter != NULL) {
        free(fitter->gradients);
        free(fitter->order);
    }
    free(fitter);
    if (generator != NULL) gsl_rng_free(generator);
    return ok;
}

bool scene_net_error(const SceneNet *network, const SceneNetSamples *samples, double *mean, Error *error) {
    double factors[SCENE_NET_SWEEPS_MAX], sum = 0;
    for (int s = 0; s < network->sweeps; s++) factors[s] = (double)network->factors[s];
    const SceneNetTask task = {0, 1, network->sweeps, factors};
    SceneNetLoss *losses = calloc((size_t)omp_get_max_threads(), sizeof *losses);
    double *errors = calloc((size_t)samples->count + 1, sizeof *errors);
    bool ok = losses != NULL && errors != NULL;
#pragma omp parallel for schedule(dynamic, 16) reduction(&& : ok) if (ok)
    for (int i = 0; i < samples->count; i++) {
        SceneNetErrors score = {0};
        if (ok)
            ok = scene_net_loss(&losses[omp_get_thread_num()], network, &samples->items[i], &task, NULL, NULL, &score);
        if (ok) errors[i] = score.error;
    }
    for (int i = 0; ok && i < samples->count; i++) sum += errors[i];
    *mean = samples->count > 0 ? sum / samples->count : NAN;
    for (int i = 0; losses != NULL && i < omp_get_max_threads(); i++) scene_net_loss_free(&losses[i]);
    free(losses);
    free(errors);
    return ok || error_memory(error, "scene-net");
}
