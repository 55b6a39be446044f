/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Networks of layers: the block of a training, memory, inference in a fixed order of sums, files. */
#include "base/base.h"
#include "base/npz.h"
#include "nets/kernels.h"
#include "nets/nets.h"

#include <stdio.h>
#include <stdlib.h>

NetworkBlock *network_block_create(const Network *shape, Error *error) {
    size_t widths = (size_t)shape->widths[0];
    for (int l = 0; l < shape->layers; l++) widths += 2 * (size_t)shape->widths[l + 1];
    NetworkBlock *block = calloc(1, sizeof *block);
    size_t size = widths * BLOCK_ROWS * sizeof(double);
    double *numbers = aligned_alloc(CACHE_LINE, size);
    if (block == NULL || numbers == NULL) return error_memory(error, "network"), free(block), free(numbers), NULL;
    memset(numbers, 0, size);
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

void network_forward(NetworkBlock *block, const double *parameters) { kernels_best()->forward(block, parameters); }

void network_backward(NetworkBlock *block, const double *parameters) { kernels_best()->backward(block, parameters); }

void network_backward_to_inputs(const NetworkBlock *block, const double *parameters, double *slopes) {
    kernels_best()->backward_to_inputs(block, parameters, slopes);
}

void network_add_gradient(const NetworkBlock *block, double *gradient) {
    kernels_best()->add_gradient(block, gradient);
}

double network_block_dot(const double *a, const double *b) { return kernels_best()->dot(a, b); }

/* Networks in memory, and inference with a fixed order of summation. */

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

/* The widths are set. */
static bool network_allocate(Network *network, Error *error) {
    float *block = calloc(number_count(network), sizeof *block);
    if (block == NULL) return error_memory(error, "network");
    place_arrays(network, block);
    for (int i = 0; i < network->widths[0]; i++) network->input.scale[i] = 1;
    for (int i = 0; i < network->widths[network->layers]; i++) network->output.scale[i] = 1;
    return true;
}

Network *network_create(int layers, const int *widths, Error *error) {
    if (layers < 1 || layers > NETWORK_MAX_LAYERS)
        return error_input(error, "network", "%d layers of weights; expected 1 to %d", layers, NETWORK_MAX_LAYERS),
               NULL;
    for (int l = 0; l <= layers; l++)
        if (widths[l] < 1 || widths[l] > NETWORK_MAX_WIDTH)
            return error_input(error, "network", "width %d of layer %d; expected 1 to %d", widths[l], l,
                               NETWORK_MAX_WIDTH),
                   NULL;
    Network *network = calloc(1, sizeof *network);
    if (network == NULL) return error_memory(error, "network"), NULL;
    network->layers = layers;
    memcpy(network->widths, widths, (size_t)(layers + 1) * sizeof *widths);
    if (!network_allocate(network, error)) return free(network), NULL;
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

void network_predict(const Network *network, const float *input, float *scratch, float *output) {
    float *in = scratch, *out = scratch + network_scratch_width(network);
    for (int i = 0; i < network->widths[0]; i++)
        in[i] = (input[i] - network->input.offset[i]) * network->input.scale[i];
    for (int l = 0; l < network->layers; l++) {
        const float *weight = network->weights[l];
        for (int j = 0; j < network->widths[l + 1]; j++) {
            float sum = network->biases[l][j];
            for (int i = 0; i < network->widths[l]; i++) sum += *weight++ * in[i];
            out[j] = activate(network->activations[l], sum);
        }
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

/* Network files: kind "network", with activations (words), weights_L and biases_L of every layer. */

enum { ACTIVATIONS_SIZE = 256 };

/* A network, and its activations in words: "sigmoid linear". */
typedef struct NetworkFile {
    Network *network;
    char activations[ACTIVATIONS_SIZE];
} NetworkFile;

static const char *const activation_names[] = {[ACTIVATION_LINEAR] = "linear",
                                               [ACTIVATION_SIGMOID] = "sigmoid",
                                               [ACTIVATION_TANH] = "tanh",
                                               [ACTIVATION_RELU] = "relu"};

enum { ACTIVATION_COUNT = sizeof activation_names / sizeof activation_names[0] };

/* A vector if there are no columns. */
static NetField layer_field(const char *name, int layer, int rows, int columns, float *data) {
    NetField field = {"", NPZ_FLOAT32, columns > 0 ? 2 : 1, {rows, columns}, .data = data, .range = &float_any};
    snprintf(field.name, sizeof field.name, "%s_%d", name, layer);
    return field;
}

static int list_fields(void *of, NetField *fields) {
    NetworkFile *file = of;
    Network *network = file->network;
    const int layers = network->layers, inputs = network->widths[0], outputs = network->widths[layers];
    const NetField
        first[] = {{"inputs", NPZ_TEXT, 0, {sizeof network->inputs}, .data = network->inputs},
                   {"outputs", NPZ_TEXT, 0, {sizeof network->outputs}, .data = network->outputs},
                   {"target", NPZ_TEXT, 0, {sizeof network->target}, .data = network->target},
                   {"command", NPZ_TEXT, 0, {sizeof network->command}, .data = network->command},
                   {"widths", NPZ_INT32, 1, {layers + 1}, .data = network->widths, .known = true},
                   {"activations", NPZ_TEXT, 0, {sizeof file->activations}, .data = file->activations}},
        last[] = {{"input_offset", NPZ_FLOAT32, 1, {inputs}, .data = network->input.offset, .range = &float_any},
                  {"input_scale", NPZ_FLOAT32, 1, {inputs}, .data = network->input.scale, .range = &float_positive},
                  {"output_offset", NPZ_FLOAT32, 1, {outputs}, .data = network->output.offset, .range = &float_any},
                  {"output_scale", NPZ_FLOAT32, 1, {outputs}, .data = network->output.scale, .range = &float_positive},
                  {"output_mean", NPZ_FLOAT32, 1, {outputs}, .data = network->output_mean, .range = &float_any}};
    NetField *at = fields + sizeof first / sizeof *first;
    memcpy(fields, first, sizeof first);
    for (int l = 0; l < layers; l++) {
        *at++ = layer_field("weights", l, network->widths[l + 1], network->widths[l], network->weights[l]);
        *at++ = layer_field("biases", l, network->widths[l + 1], 0, network->biases[l]);
    }
    memcpy(at, last, sizeof last);
    return (int)(at - fields) + (int)(sizeof last / sizeof *last);
}

static bool read_widths(void *of, NpzFile *file, Error *error) {
    Network *network = ((NetworkFile *)of)->network;
    const int count = net_file_integers(file, "widths", 2, NETWORK_MAX_LAYERS + 1, network->widths, error);
    for (int l = 0; l < count; l++)
        if (network->widths[l] < 1 || network->widths[l] > NETWORK_MAX_WIDTH)
            return error_input(error, npz_path(file), "widths[%d] is %d; expected 1 to %d", l, network->widths[l],
                               NETWORK_MAX_WIDTH);
    network->layers = count - 1;
    return count > 0;
}

static bool create_network(void *of, Error *error) { return network_allocate(((NetworkFile *)of)->network, error); }

static bool parse_activations(void *of, const char *path, Error *error) {
    NetworkFile *file = of;
    Network *network = file->network;
    char *rest = file->activations;
    int count = 0;
    for (char *word; (word = strtok_r(rest, " ", &rest)) != NULL; count++) {
        if (count == network->layers) return error_input(error, path, "more activations than its %d layers", count);
        int a = 0;
        while (a < ACTIVATION_COUNT && strcmp(word, activation_names[a]) != 0) a++;
        network->activations[count] = (Activation)a;
        if (a == ACTIVATION_COUNT)
            return error_input(error, path, "activation %d is unknown; known: linear, sigmoid, tanh, relu", count);
    }
    return count == network->layers || error_input(error, path, "%d activations for %d layers", count, network->layers);
}

static const NetFileKind kind = {"network",   NETWORK_VERSION, list_fields,
                                 read_widths, create_network,  parse_activations};

bool network_write(const Network *network, const char *path, Error *error) {
    NetworkFile file = {(Network *)network, ""};
    for (int l = 0; l < network->layers; l++)
        text_add(file.activations, sizeof file.activations, "%s%s", l > 0 ? " " : "",
                 activation_names[network->activations[l]]);
    return net_file_write(&kind, &file, path, error);
}

Network *network_read(const char *path, Error *error) {
    NetworkFile file = {calloc(1, sizeof *file.network), ""};
    if (file.network == NULL) return error_memory(error, path), NULL;
    if (net_file_read(&kind, &file, path, error)) return file.network;
    network_destroy(file.network);
    return NULL;
}
