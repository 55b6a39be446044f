/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each step forward beside its step back; B stands for BLOCK_ROWS. */
#include "network/network_gradient.h"

#include <math.h>
#include <stdlib.h>

/* Rows that a sum carries along at once, in registers. */
enum { LANES = 8 };

static size_t parameter_count(const Network *shape, int l) {
    return (size_t)shape->widths[l + 1] * (size_t)(shape->widths[l] + 1);
}

NetworkBlock *network_block_create(const Network *shape, Error *error) {
    size_t widths = (size_t)shape->widths[0];
    for (int l = 0; l < shape->layers; l++) widths += 2 * (size_t)shape->widths[l + 1];
    NetworkBlock *block = calloc(1, sizeof *block);
    double *numbers = calloc(widths * BLOCK_ROWS, sizeof *numbers);
    if (block == NULL || numbers == NULL) return error_memory(error, "network"), free(block), free(numbers), NULL;
    block->shape = shape;
    for (int l = 0; l <= shape->layers; l++) {
        block->values[l] = numbers;
        numbers += shape->widths[l] * BLOCK_ROWS;
    }
    for (int l = 0; l < shape->layers; l++) {
        block->deltas[l] = numbers;
        numbers += shape->widths[l + 1] * BLOCK_ROWS;
    }
    return block;
}

void network_block_destroy(NetworkBlock *block) {
    if (block == NULL) return;
    free(block->values[0]);
    free(block);
}

/* sums[B] = start + sum over k of weights[k * weight_step] * values[k, B] */
static void weighted_sum(double *restrict sums, double start, const double *restrict weights, int weight_step,
                         const double *restrict values, int count) {
    for (int r = 0; r < BLOCK_ROWS; r += LANES) {
        double lane[LANES];
        for (int t = 0; t < LANES; t++) lane[t] = start;
        for (int k = 0; k < count; k++) {
            double weight = weights[(size_t)k * (size_t)weight_step];
            for (int t = 0; t < LANES; t++) lane[t] += weight * values[(size_t)k * BLOCK_ROWS + (size_t)(r + t)];
        }
        for (int t = 0; t < LANES; t++) sums[r + t] = lane[t];
    }
}

static double lane_total(const double lane[LANES]) {
    return ((lane[0] + lane[1]) + (lane[2] + lane[3])) + ((lane[4] + lane[5]) + (lane[6] + lane[7]));
}

/* Sum of a[B] */
static double row_sum(const double *a) {
    double lane[LANES] = {0};
    for (int r = 0; r < BLOCK_ROWS; r += LANES)
        for (int t = 0; t < LANES; t++) lane[t] += a[r + t];
    return lane_total(lane);
}

double network_block_dot(const double *a, const double *b) {
    double lane[LANES] = {0};
    for (int r = 0; r < BLOCK_ROWS; r += LANES)
        for (int t = 0; t < LANES; t++) lane[t] += a[r + t] * b[r + t];
    return lane_total(lane);
}

/* y = activation(x), in place */
static void activation_forward(Activation activation, double *values, size_t count) {
    if (activation == ACTIVATION_SIGMOID)
        for (size_t i = 0; i < count; i++) values[i] = 1 / (1 + exp(-values[i]));
    if (activation == ACTIVATION_TANH)
        for (size_t i = 0; i < count; i++) values[i] = tanh(values[i]);
}

/* d loss / dx = d loss / dy * dy / dx, in place; both slopes follow from y alone */
static void activation_backward(Activation activation, const double *restrict values, double *restrict deltas,
                                size_t count) {
    if (activation == ACTIVATION_SIGMOID)
        for (size_t i = 0; i < count; i++) deltas[i] *= values[i] * (1 - values[i]);
    if (activation == ACTIVATION_TANH)
        for (size_t i = 0; i < count; i++) deltas[i] *= 1 - values[i] * values[i];
}

/* out[outputs, B] = weights[outputs, inputs] in[inputs, B] + biases[outputs] */
static void layer_forward(const double *parameters, int inputs, int outputs, const double *in, double *out) {
    const double *biases = parameters + (size_t)outputs * (size_t)inputs;
    for (int j = 0; j < outputs; j++)
        weighted_sum(out + (size_t)j * BLOCK_ROWS, biases[j], parameters + (size_t)j * (size_t)inputs, 1, in, inputs);
}

/* delta_in[inputs, B] = weights^T[inputs, outputs] delta_out[outputs, B] */
static void layer_backward(const double *parameters, int inputs, int outputs, const double *delta_out,
                           double *delta_in) {
    for (int i = 0; i < inputs; i++)
        weighted_sum(delta_in + (size_t)i * BLOCK_ROWS, 0, parameters + i, inputs, delta_out, outputs);
}

void network_forward(NetworkBlock *block, const double *parameters) {
    const Network *shape = block->shape;
    for (int l = 0; l < shape->layers; l++) {
        layer_forward(parameters, shape->widths[l], shape->widths[l + 1], block->values[l], block->values[l + 1]);
        activation_forward(shape->activations[l], block->values[l + 1], (size_t)shape->widths[l + 1] * BLOCK_ROWS);
        parameters += parameter_count(shape, l);
    }
}

void network_backward(NetworkBlock *block, const double *parameters) {
    const Network *shape = block->shape;
    for (int l = 0; l < shape->layers; l++) parameters += parameter_count(shape, l);
    for (int l = shape->layers - 1; l >= 0; l--) {
        parameters -= parameter_count(shape, l);
        activation_backward(shape->activations[l], block->values[l + 1], block->deltas[l],
                            (size_t)shape->widths[l + 1] * BLOCK_ROWS);
        if (l > 0)
            layer_backward(parameters, shape->widths[l], shape->widths[l + 1], block->deltas[l], block->deltas[l - 1]);
    }
}

void network_add_gradient(const NetworkBlock *block, double *gradient) {
    const Network *shape = block->shape;
    for (int l = 0; l < shape->layers; l++) {
        const double *delta = block->deltas[l];
        for (int j = 0; j < shape->widths[l + 1]; j++)
            for (int i = 0; i < shape->widths[l]; i++)
                *gradient++ +=
                    network_block_dot(delta + (size_t)j * BLOCK_ROWS, block->values[l] + (size_t)i * BLOCK_ROWS);
        for (int j = 0; j < shape->widths[l + 1]; j++) *gradient++ += row_sum(delta + (size_t)j * BLOCK_ROWS);
    }
}
