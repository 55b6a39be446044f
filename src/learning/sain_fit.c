/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fit of sain: the loss and its gradient, normalisation and ranges, steps, errors on other samples. */
#include "learning/sain_fit.h"

#include "base/base.h"
#include "base/random.h"
#include "learning/learning.h"
#include "methods/sain.h"
#include "methods/sain_view.h"
#include "nets/nets.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

/* Errors count in proportion to the scale of the outputs, so that a box at rest, which must not creep, counts as much
   as one in a crash; `slow` (m/s) is added to the scale. Below `smooth_below` by their square, as in Ajay et al., above
   by their size: a few crashes would outweigh all else. */
static const double slow = 0.2, smooth_below = 1;

int sain_weight_count(const SainNetwork *network) {
    return network_parameter_count(network->relation) + network_parameter_count(network->object);
}

bool sain_loss_begin(SainLoss *loss, const SainNetwork *network, Error *error) {
    loss->network = network;
    loss->object = network_block_create(network->object, error);
    if (loss->object == NULL) return false;
    loss->slopes = calloc((size_t)SAIN_OBJECT_INPUTS * BLOCK_ROWS, sizeof *loss->slopes);
    return loss->slopes != NULL || error_memory(error, "sain");
}

void sain_loss_free(SainLoss *loss) {
    for (int i = 0; i < loss->block_count; i++) network_block_destroy(loss->relation[i]);
    network_block_destroy(loss->object);
    free(loss->relation);
    free(loss->slopes);
    *loss = (SainLoss){0};
}

static int block_count(const SainPart *part) {
    int rows = 0;
    for (int i = 0; i < part->count; i++) rows += part->samples->items[part->items[i]].rows;
    return (rows + BLOCK_ROWS - 1) / BLOCK_ROWS;
}

/* Normalised numbers to row `row` of a block. */
static void fill_row(double *values, int row, const float *numbers, int count, const Normalisation *by) {
    for (int i = 0; i < count; i++)
        values[i * BLOCK_ROWS + row] = ((double)numbers[i] - (double)by->offset[i]) * (double)by->scale[i];
}

/* Answers to a part: object->values of its last layer, [SAIN_OUTPUTS, BLOCK_ROWS]. False when memory is short. */
static bool forward(SainLoss *loss, const SainPart *part, const double *weights) {
    const SainNetwork *network = loss->network;
    const SainSamples *samples = part->samples;
    const int blocks = block_count(part);
    Error error = {0};
    if (!array_reserve((void **)&loss->relation, &loss->block_capacity, (size_t)blocks, sizeof *loss->relation))
        return false;
    for (; loss->block_count < blocks; loss->block_count++)
        if ((loss->relation[loss->block_count] = network_block_create(network->relation, &error)) == NULL) return false;

    for (int i = 0, r = 0; i < part->count; i++) {
        const SainSample *sample = &samples->items[part->items[i]];
        for (int k = 0; k < sample->rows; k++, r++)
            fill_row(loss->relation[r / BLOCK_ROWS]->values[0], r % BLOCK_ROWS,
                     samples->rows[sample->first + k].numbers, SAIN_PAIR_INPUTS, &network->relation->input);
    }
    for (int b = 0; b < blocks; b++) network_forward(loss->relation[b], weights);

    /* The object network sees the body's inputs, then sums of effects. */
    const Normalisation *by = &network->object->input;
    double *values = loss->object->values[0];
    for (int i = 0, r = 0; i < part->count; i++) {
        const SainSample *sample = &samples->items[part->items[i]];
        fill_row(values, i, sample->body, SAIN_BODY_INPUTS, by);
        for (int e = 0; e < SAIN_EFFECTS; e++) {
            const int at = SAIN_BODY_INPUTS + e;
            double sum = 0;
            for (int k = r; k < r + sample->rows; k++)
                sum +=
                    loss->relation[k / BLOCK_ROWS]->values[network->relation->layers][e * BLOCK_ROWS + k % BLOCK_ROWS];
            values[at * BLOCK_ROWS + i] = (sum - (double)by->offset[at]) * (double)by->scale[at];
        }
        r += sample->rows;
    }
    network_forward(loss->object, weights + network_parameter_count(network->relation));
    return true;
}

/* Returns the loss of the answers; fills the slopes of the outputs, 0 in unused rows. */
static double judge(SainLoss *loss, const SainPart *part) {
    const int last = loss->object->shape->layers;
    double *deltas = loss->object->deltas[last - 1], sum = 0;
    const double *outputs = loss->object->values[last];
    memset(deltas, 0, (size_t)SAIN_OUTPUTS * BLOCK_ROWS * sizeof *deltas);
    for (int i = 0; i < part->count; i++) {
        const SainSample *sample = &part->samples->items[part->items[i]];
        const double scale = (double)sample->scale, by = 1 / (scale + slow);
        for (int o = 0; o < SAIN_OUTPUTS; o++) {
            const double error = by * (scale * outputs[o * BLOCK_ROWS + i] - (double)sample->target[o]),
                         size = fabs(error);
            const bool small = size < smooth_below;
            sum += small ? error * error / 2 : smooth_below * (size - smooth_below / 2);
            deltas[o * BLOCK_ROWS + i] = by * scale * (small ? error : copysign(smooth_below, error));
        }
    }
    return sum;
}

bool sain_loss_add(SainLoss *loss, const SainPart *part, const double *weights, double *sum, double *gradient) {
    const Network *relation = loss->network->relation;
    const int object = network_parameter_count(relation), blocks = block_count(part), last = relation->layers - 1;
    const float *scale = loss->network->object->input.scale + SAIN_BODY_INPUTS;
    if (!forward(loss, part, weights)) return false;
    *sum += judge(loss, part);
    network_backward(loss->object, weights + object);
    network_add_gradient(loss->object, gradient + object);
    network_backward_to_inputs(loss->object, weights + object, loss->slopes);

    /* From the slopes of the sums to those of each row's effects. */
    for (int b = 0; b < blocks; b++)
        memset(loss->relation[b]->deltas[last], 0, (size_t)SAIN_EFFECTS * BLOCK_ROWS * sizeof(double));
    for (int i = 0, r = 0; i < part->count; i++)
        for (int k = 0; k < part->samples->items[part->items[i]].rows; k++, r++)
            for (int e = 0; e < SAIN_EFFECTS; e++)
                loss->relation[r / BLOCK_ROWS]->deltas[last][e * BLOCK_ROWS + r % BLOCK_ROWS] =
                    loss->slopes[(SAIN_BODY_INPUTS + e) * BLOCK_ROWS + i] * (double)scale[e];
    for (int b = 0; b < blocks; b++) {
        network_backward(loss->relation[b], weights);
        network_add_gradient(loss->relation[b], gradient);
    }
    return true;
}

/* Inputs of new launches exceed those of the training by a little; a share of the range on both sides is allowed. */
static const float widen = 0.1f;
static const float limit_widen = 1.5f; /* of the largest correction */
static const double output_weight = 0.1;
/* Of the weights, in proportion to the rate: a few launches have fewer impacts than the network has weights. Source:
   Loshchilov, Hutter, "Decoupled Weight Decay Regularization" (2019). */
static const double shrink = 3;

/* One number of each item; the sums of all. */
typedef struct Moments {
    double sum, square;
    float low, high;
    size_t count;
} Moments;

static Moments moments_of(const void *first, size_t stride, size_t count) {
    Moments moments = {.low = INFINITY, .high = -INFINITY, .count = count};
    const char *at = first;
    for (size_t i = 0; i < count; i++, at += stride) {
        float x;
        memcpy(&x, at, sizeof x);
        moments.sum += (double)x;
        moments.square += (double)x * (double)x;
        moments.low = x < moments.low ? x : moments.low;
        moments.high = x > moments.high ? x : moments.high;
    }
    return moments;
}

/* Inputs that never change keep their size. */
static void standardise(const Moments *moments, float *offset, float *scale) {
    const double n = (double)moments->count, mean = moments->sum / n, variance = moments->square / n - mean * mean;
    *offset = (float)mean;
    *scale = moments->high > moments->low && variance > 1e-12 ? (float)(1 / sqrt(variance)) : 1.0f;
}

void sain_normalise(SainNetwork *network, const SainSamples *samples) {
    for (int i = 0; i < SAIN_PAIR_INPUTS; i++) {
        const Moments moments = moments_of(&samples->rows[0].numbers[i], sizeof *samples->rows, samples->row_count);
        standardise(&moments, &network->relation->input.offset[i], &network->relation->input.scale[i]);
    }
    for (int i = 0; i < SAIN_BODY_INPUTS; i++) {
        const Moments moments = moments_of(&samples->items[0].body[i], sizeof *samples->items, samples->count);
        standardise(&moments, &network->object->input.offset[i], &network->object->input.scale[i]);
    }
}

static void set_range(const Moments *moments, float *low, float *high) {
    const float margin = widen * (moments->high - moments->low);
    *low = moments->low - margin;
    *high = moments->high + margin;
}

void sain_set_ranges(SainNetwork *network, const SainSamples *samples) {
    for (int i = 0; i < SAIN_PAIR_INPUTS; i++) {
        const Moments moments = moments_of(&samples->rows[0].numbers[i], sizeof *samples->rows, samples->row_count);
        set_range(&moments, &network->pair_low[i], &network->pair_high[i]);
    }
    for (int i = 0; i < SAIN_BODY_INPUTS; i++) {
        const Moments moments = moments_of(&samples->items[0].body[i], sizeof *samples->items, samples->count);
        set_range(&moments, &network->body_low[i], &network->body_high[i]);
    }
    for (int o = 0; o < SAIN_OUTPUTS; o++) {
        float most = 0;
        for (size_t i = 0; i < samples->count; i++) {
            const SainSample *sample = &samples->items[i];
            const float size = fabsf(sample->target[o]);
            if (size <= sample->scale * SAIN_ANSWER_MAX && size > most * sample->scale) most = size / sample->scale;
        }
        network->limit[o] = limit_widen * most;
    }
}

void sain_first_weights(const SainNetwork *network, uint64_t seed, double *weights) {
    const Network *relation = network->relation, *object = network->object;
    uint64_t state = seed;
    for (int l = 0; l < relation->layers; l++)
        weights = weights_of_layer(weights, relation->widths[l], relation->widths[l + 1], 1, &state);
    for (int l = 0; l < object->layers; l++)
        weights = weights_of_layer(weights, object->widths[l], object->widths[l + 1],
                                   l + 1 < object->layers ? 1 : output_weight, &state);
}

void sain_set_weights(SainNetwork *network, const double *weights) {
    const int relation = network_parameter_count(network->relation), object = network_parameter_count(network->object);
    for (int i = 0; i < relation; i++) network->relation->weights[0][i] = (float)weights[i];
    for (int i = 0; i < object; i++) network->object->weights[0][i] = (float)weights[relation + i];
}

bool sain_fit_begin(SainFit *fit, SainNetwork *network, const SainSamples *samples, int batch, Error *error) {
    *fit = (SainFit){.samples = samples, .network = network, .batch = batch};
    fit->gradients = calloc((size_t)SAIN_PARTS * (size_t)sain_weight_count(network), sizeof *fit->gradients);
    if (fit->gradients == NULL) return error_memory(error, "sain");
    for (int p = 0; p < SAIN_PARTS; p++)
        if (!sain_loss_begin(&fit->losses[p], network, error)) return false;
    return true;
}

void sain_fit_free(SainFit *fit) {
    for (int p = 0; p < SAIN_PARTS; p++) sain_loss_free(&fit->losses[p]);
    free(fit->gradients);
    *fit = (SainFit){0};
}

bool sain_fit_step(SainFit *fit, Adam *adam, uint64_t seed, int64_t number, double rate, double *loss, Error *error) {
    const size_t weights = (size_t)adam->count;
    double sums[SAIN_PARTS] = {0};
    bool ok = true;
    /* Drawn with replacement: what a step draws depends on no other step. */
    uint64_t state = seed + (uint64_t)number * UINT64_C(0x9e3779b97f4a7c15);
    split_mix(&state);
    for (int i = 0; i < fit->batch; i++)
        fit->items[i % SAIN_PARTS][i / SAIN_PARTS] = random_below(&state, (int)fit->samples->count);
    memset(fit->gradients, 0, SAIN_PARTS * weights * sizeof *fit->gradients);
#pragma omp parallel for schedule(dynamic, 1) reduction(&& : ok)
    for (int p = 0; p < SAIN_PARTS; p++) {
        const SainPart part = {fit->samples, fit->items[p], (fit->batch + SAIN_PARTS - 1 - p) / SAIN_PARTS};
        const bool done =
            sain_loss_add(&fit->losses[p], &part, adam->weights, &sums[p], fit->gradients + (size_t)p * weights);
        ok = ok && done;
    }
    if (!ok) return error_memory(error, "sain");
    *loss = 0;
    for (int p = 0; p < SAIN_PARTS; p++) *loss += sums[p] / fit->batch;
    for (size_t i = 0; i < weights; i++) {
        double slope = 0;
        for (size_t p = 0; p < SAIN_PARTS; p++) slope += fit->gradients[p * weights + i];
        fit->gradients[i] = slope / fit->batch;
    }
    adam_step(adam, fit->gradients, rate);
    for (size_t i = 0; i < weights; i++) adam->weights[i] *= 1 - rate * shrink;
    return true;
}

/* Whether the method would use the answer (methods/sain.c). */
static bool is_used(const SainNetwork *network, const SainSamples *samples, const SainSample *sample,
                    const double *outputs) {
    bool used = true;
    for (int o = 0; o < SAIN_OUTPUTS; o++) used = used && fabs(outputs[o * BLOCK_ROWS]) <= (double)network->limit[o];
    for (int i = 0; i < SAIN_BODY_INPUTS; i++)
        used = used && sample->body[i] >= network->body_low[i] && sample->body[i] <= network->body_high[i];
    for (int r = sample->first; r < sample->first + sample->rows; r++)
        for (int i = 0; i < SAIN_PAIR_INPUTS; i++) {
            const float x = samples->rows[r].numbers[i];
            used = used && x >= network->pair_low[i] && x <= network->pair_high[i];
        }
    return used;
}

bool sain_fit_errors(SainFit *fit, const double *weights, const SainSamples *samples, SainErrors *errors,
                     Error *error) {
    SainLoss *loss = &fit->losses[0];
    double mean[SAIN_OUTPUTS] = {0}, with = 0, without = 0, constant = 0;
    const double count = (double)samples->count;
    for (int o = 0; o < SAIN_OUTPUTS; o++) {
        for (size_t i = 0; i < fit->samples->count; i++) mean[o] += (double)fit->samples->items[i].target[o];
        mean[o] /= (double)fit->samples->count;
    }
    for (size_t first = 0; first < samples->count;) {
        SainPart part = {samples, fit->items[0], 0};
        for (; part.count < BLOCK_ROWS && first < samples->count; first++) fit->items[0][part.count++] = (int)first;
        if (!forward(loss, &part, weights)) return error_memory(error, "sain");
        for (int i = 0; i < part.count; i++) {
            const SainSample *sample = &samples->items[part.items[i]];
            const double *outputs = loss->object->values[loss->object->shape->layers] + i;
            const bool used = is_used(fit->network, samples, sample, outputs);
            for (int o = 0; o < SAIN_OUTPUTS; o++) {
                const double target = (double)sample->target[o], off = mean[o] - target,
                             left = (used ? (double)sample->scale * outputs[o * BLOCK_ROWS] : 0) - target;
                with += left * left;
                without += target * target;
                constant += off * off;
            }
        }
    }
    *errors = (SainErrors){sqrt(with / count), sqrt(without / count), sqrt(constant / count)};
    return true;
}
