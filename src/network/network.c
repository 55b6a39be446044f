/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Networks in memory, and inference with a fixed order of summation. */
#include "network/network.h"

#include "network/activation.h"
#include "network/kernels.h"

#include <stdlib.h>
#include <string.h>

static bool check_widths(int layers, const int *widths, Error *error) {
    if (layers < 1 || layers > NETWORK_MAX_LAYERS)
        return error_input(error, "network", "%d layers of weights; expected 1 to %d", layers, NETWORK_MAX_LAYERS);
    for (int l = 0; l <= layers; l++)
        if (widths[l] < 1 || widths[l] > NETWORK_MAX_WIDTH)
            return error_input(error, "network", "width %d of layer %d; expected 1 to %d", widths[l], l,
                               NETWORK_MAX_WIDTH);
    return true;
}

/* Parameters, normalisations, and the mean of the outputs. */
static size_t number_count(const Network *network) {
    return (size_t)network_parameter_count(network) + 2 * (size_t)network->widths[0] +
           3 * (size_t)network->widths[network->layers];
}

/* One block, so that the parameters are one vector in training. */
static void place_arrays(Network *network, float *block) {
    for (int l = 0; l < network->layers; l++) {
        network->weights[l] = block;
        network->biases[l] = block + (size_t)network->widths[l + 1] * (size_t)network->widths[l];
        block = network->biases[l] + network->widths[l + 1];
    }
    int inputs = network->widths[0], outputs = network->widths[network->layers];
    network->input = (Normalisation){block, block + inputs};
    block += 2 * inputs;
    network->output = (Normalisation){block, block + outputs};
    network->output_mean = block + 2 * outputs;
}

Network *network_create(int layers, const int *widths, Error *error) {
    if (!check_widths(layers, widths, error)) return NULL;
    Network *network = calloc(1, sizeof *network);
    if (network == NULL) return error_memory(error, "network"), NULL;
    network->layers = layers;
    memcpy(network->widths, widths, (size_t)(layers + 1) * sizeof *widths);
    float *block = calloc(number_count(network), sizeof *block);
    if (block == NULL) return error_memory(error, "network"), free(network), NULL;
    place_arrays(network, block);
    for (int i = 0; i < widths[0]; i++) network->input.scale[i] = 1;
    for (int i = 0; i < widths[layers]; i++) network->output.scale[i] = 1;
    return network;
}

Network *network_copy(const Network *network, Error *error) {
    Network *copy = network_create(network->layers, network->widths, error);
    if (copy == NULL) return NULL;
    float *block = copy->weights[0];
    memcpy(block, network->weights[0], number_count(network) * sizeof *block);
    *copy = *network;
    place_arrays(copy, block);
    return copy;
}

void network_destroy(Network *network) {
    if (network == NULL) return;
    free(network->weights[0]);
    free(network);
}

int network_parameter_count(const Network *network) {
    int count = 0;
    for (int l = 0; l < network->layers; l++) count += network->widths[l + 1] * (network->widths[l] + 1);
    return count;
}

int network_scratch_width(const Network *network) {
    int width = 0;
    for (int l = 0; l <= network->layers; l++)
        if (network->widths[l] > width) width = network->widths[l];
    return width;
}

static float activate(Activation activation, float x) {
    switch (activation) {
    case ACTIVATION_SIGMOID: return sigmoid_float(x);
    case ACTIVATION_TANH: return tanh_float(x);
    case ACTIVATION_RELU: return relu_float(x);
    case ACTIVATION_LINEAR: break;
    }
    return x;
}

/* out[widths[l + 1]] = activation(biases + weights in[widths[l]]) */
static void predict_layer(const Network *network, int l, const float *in, float *out) {
    const float *weight = network->weights[l];
    for (int j = 0; j < network->widths[l + 1]; j++) {
        float sum = network->biases[l][j];
        for (int i = 0; i < network->widths[l]; i++) sum += *weight++ * in[i];
        out[j] = activate(network->activations[l], sum);
    }
}

void network_predict(const Network *network, const float *input, float *scratch, float *output) {
    float *in = scratch, *out = scratch + network_scratch_width(network);
    for (int i = 0; i < network->widths[0]; i++)
        in[i] = (input[i] - network->input.offset[i]) * network->input.scale[i];
    for (int l = 0; l < network->layers; l++) {
        predict_layer(network, l, in, out);
        float *swap = in;
        in = out;
        out = swap;
    }
    for (int k = 0; k < network->widths[network->layers]; k++)
        output[k] = in[k] / network->output.scale[k] + network->output.offset[k];
}

size_t network_batch_scratch(const Network *network) {
    return 2 * (size_t)network_scratch_width(network) * TILE_ROWS + CACHE_LINE / sizeof(float);
}

void network_predict_batch(const Network *network, const float *inputs, float *scratch, float *outputs, int rows) {
    const Kernels *kernels = kernels_best();
    for (int first = 0; first < rows; first += TILE_ROWS) {
        int count = rows - first < TILE_ROWS ? rows - first : TILE_ROWS;
        kernels->predict(network, inputs, scratch, outputs, rows, first, count);
    }
}
