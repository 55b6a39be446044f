/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact_training/slot_loss.h"

#include "common/array.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double linear_from = 0.3;  /* threshold of smooth L1, in scales */
static const double least_error = 0.01; /* m/s: below it the loss is nearly quadratic */

void slot_loss_free(SlotLoss *loss) {
    unrolled_free(&loss->unrolled);
    free(loss->outputs);
    free(loss->by_outputs);
    free(loss->numbers);
    *loss = (SlotLoss){0};
}

static bool reserve(SlotLoss *loss, const SlotSample *sample) {
    const size_t contacts = (size_t)sample->problem.contact_count, bodies = (size_t)sample->problem.body_count;
    return array_reserve((void **)&loss->outputs, &loss->output_capacity, 2 * contacts + 2, sizeof(float)) &&
           array_reserve((void **)&loss->by_outputs, &loss->by_output_capacity, 2 * contacts + 2, sizeof(float)) &&
           array_reserve((void **)&loss->numbers, &loss->number_capacity, 4 * contacts + 3 * bodies, sizeof(double));
}

/* Smooth L1 and its derivative. */
static double smooth(double x, double *by) {
    const double size = fabs(x);
    *by = size < linear_from ? x / linear_from : copysign(1, x);
    return size < linear_from ? x * x / (2 * linear_from) : size - linear_from / 2;
}

/* Returns the impulse loss; writes its derivative with respect to the outputs. */
static double impulse_loss(const SlotNetwork *network, const SlotSample *sample, const double *start, double weight,
                           float *by_outputs) {
    const SlotView *slots = &sample->view.slots;
    double sum = 0;
    for (int i = 0; i < slots->slot_count; i++) {
        const int contact = sample->view.contacts[i];
        const double scale = (double)network->scale[slots->slots[i]], share = weight / slots->slot_count;
        const double goal[2] = {(double)sample->goal[contact].normal, (double)sample->goal[contact].tangent};
        for (int k = 0; k < 2; k++) {
            double by;
            sum += share * smooth((start[2 * contact + k] - goal[k]) / scale, &by);
            by_outputs[2 * i + k] = (float)(share * by / scale);
        }
    }
    return sum;
}

/* The squared error summed over the dynamic bodies, weighted as in solution_error.h, and half its derivative. */
static double velocity_error(const SlotSample *sample, const double *velocities, double *by_velocity, int *counted) {
    double sum = 0;
    *counted = 0;
    for (int i = 0; i < sample->problem.body_count; i++) {
        const ReferenceVelocity *goal = &sample->reference[i];
        double *by = by_velocity + 3 * i;
        by[0] = velocities[3 * i] - goal->x;
        by[1] = velocities[3 * i + 1] - goal->y;
        by[2] = (velocities[3 * i + 2] - goal->spin) / 6;
        if (!(sample->problem.bodies[i].inv_mass > 0)) by[0] = by[1] = by[2] = 0;
        *counted += sample->problem.bodies[i].inv_mass > 0;
        sum += by[0] * by[0] + by[1] * by[1] + 6 * by[2] * by[2];
    }
    return sum;
}

/* Adds the velocity loss to the score and, if `back`, its derivative to loss->by_outputs. */
static bool velocity_loss(SlotLoss *loss, const SlotSample *sample, const SlotTask *task, bool back, double *by_factors,
                          SlotScore *score) {
    const SlotView *slots = &sample->view.slots;
    const int contacts = sample->problem.contact_count;
    double *start = loss->numbers, *by_start = start + 2 * contacts, *by_velocity = by_start + 2 * contacts;
    if (!unrolled_run(&loss->unrolled, &sample->unrolled, start, task->factors, task->sweeps)) return false;
    int counted;
    const double sum = velocity_error(sample, loss->unrolled.velocities, by_velocity, &counted);
    score->error = counted > 0 ? sqrt(sum / counted) : 0;
    const double root = sqrt(score->error * score->error + least_error * least_error);
    score->loss += task->velocity_weight * root;
    if (!back) return true;
    for (int i = 0; i < 3 * sample->problem.body_count; i++) by_velocity[i] *= task->velocity_weight / (counted * root);
    unrolled_back(&loss->unrolled, &sample->unrolled, by_velocity, by_start, by_factors);
    for (int i = 0; i < slots->slot_count; i++)
        for (int k = 0; k < 2; k++) loss->by_outputs[2 * i + k] += (float)by_start[2 * sample->view.contacts[i] + k];
    return true;
}

/* The gradient entry of a parameter. */
static float *place(const SlotNetwork *network, float *gradient, const float *parameter) {
    return gradient + (parameter - network->parameters);
}

static void back_through_layer(const SlotNetwork *network, const SlotLayer *layer, const float *in, const float *out,
                               float *by_out, float *by_in, float *gradient) {
    const RowKernels *kernels = network->kernels;
    float *biases = place(network, gradient, layer->biases);
    for (int j = 0; j < layer->to; j++) by_out[j] *= 1 - out[j] * out[j];
    for (int j = 0; j < layer->to; j++) biases[j] += by_out[j];
    kernels->spread(place(network, gradient, layer->rows), layer->to, NULL, in, by_out, layer->from);
    if (by_in != NULL) kernels->multiply(by_in, &layer->packed, NULL, by_out, layer->from / 2);
}

static void back(SlotLoss *loss, const SlotNetwork *network, const SlotSample *sample, float *gradient) {
    const SlotView *slots = &sample->view.slots;
    const RowKernels *kernels = network->kernels;
    const int hidden = slot_network_hidden(network), outputs = 2 * slots->slot_count;
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

bool slot_loss(SlotLoss *loss, const SlotNetwork *network, const SlotSample *sample, const SlotTask *task,
               float *gradient, double *by_factors, SlotScore *score) {
    if (!reserve(loss, sample)) return false;
    const SlotView *slots = &sample->view.slots;
    slot_network_predict(network, sample->inputs, slots, loss->first, loss->second, loss->outputs);
    double *start = loss->numbers;
    for (int i = 0; i < sample->problem.contact_count; i++) {
        start[2 * i] = (double)sample->view.base[i].normal;
        start[2 * i + 1] = (double)sample->view.base[i].tangent;
    }
    for (int i = 0; i < slots->slot_count; i++)
        for (int k = 0; k < 2; k++) start[2 * sample->view.contacts[i] + k] += (double)loss->outputs[2 * i + k];
    *score = (SlotScore){.loss = impulse_loss(network, sample, start, task->impulse_weight, loss->by_outputs)};
    const bool run_sweeps = task->velocity_weight > 0 || gradient == NULL;
    if (run_sweeps && !velocity_loss(loss, sample, task, gradient != NULL, by_factors, score)) return false;
    if (gradient != NULL) back(loss, network, sample, gradient);
    return true;
}
