/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/npz.h"
#include "nets/kernels.h"
#include "nets/nets.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

const FloatBounds float_any = {-FLT_MAX, FLT_MAX, "finite"};
const FloatBounds float_positive = {FLT_TRUE_MIN, FLT_MAX, "finite and greater than 0"};
const FloatBounds float_not_negative = {0, FLT_MAX, "finite and not negative"};
const FloatBounds float_momentum = {0, 2, "from 0 to 2"};

NpzArray file_floats_array(const FileFloats *floats) {
    return (NpzArray){floats->name, NPZ_FLOAT32, floats->rank, {floats->shape[0], floats->shape[1]}, floats->numbers};
}

static bool read(NpzFile *file, const FileFloats *floats, Error *error) {
    float *numbers = npz_read(file, floats->name, NPZ_FLOAT32, floats->rank, floats->shape, error);
    if (numbers == NULL) return false;
    size_t size = 1, i = 0;
    for (int r = 0; r < floats->rank; r++) size *= (size_t)floats->shape[r];
    while (i < size && numbers[i] >= floats->range->least && numbers[i] <= floats->range->most) i++;
    if (i == size)
        memcpy(floats->numbers, numbers, size * sizeof *numbers);
    else
        error_input(error, npz_path(file), "%s: number %zu is %g; it must be %s", floats->name, i, (double)numbers[i],
                    floats->range->words);
    free(numbers);
    return i == size;
}

bool file_floats_expect(const NpzFile *file, const FileFloats *list, int count, Error *error) {
    for (int i = 0; i < count; i++) {
        const NpzArray array = file_floats_array(&list[i]);
        if (!npz_expect(file, &array, 1, error)) return false;
    }
    return true;
}

bool file_floats_read(NpzFile *file, const FileFloats *list, int count, Error *error) {
    if (!file_floats_expect(file, list, count, error)) return false;
    for (int i = 0; i < count; i++)
        if (!read(file, &list[i], error)) return false;
    return true;
}

/* Networks in memory, and inference with a fixed order of summation. */

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

/* Network files: .npz with version, kind ("network"), widths[layers + 1], activations (words), weights_L and
   biases_L for every layer, input_offset, input_scale, output_offset, output_scale, output_mean, inputs, outputs,
   target, command. */

#define KIND "network"

enum { ACTIVATIONS_SIZE = 256, MAX_FLOATS = 5 + 2 * NETWORK_MAX_LAYERS, MAX_ARRAYS = 8 + MAX_FLOATS };

static const char *const activation_names[] = {[ACTIVATION_LINEAR] = "linear",
                                               [ACTIVATION_SIGMOID] = "sigmoid",
                                               [ACTIVATION_TANH] = "tanh",
                                               [ACTIVATION_RELU] = "relu"};

enum { ACTIVATION_COUNT = sizeof activation_names / sizeof activation_names[0] };

/* One list for writing and reading. */
static int list_floats(const Network *network, FileFloats list[MAX_FLOATS]) {
    int count = 0, inputs = network->widths[0], outputs = network->widths[network->layers];
    for (int l = 0; l < network->layers; l++) {
        int rows = network->widths[l + 1], columns = network->widths[l];
        list[count] = (FileFloats){"", 2, {rows, columns}, network->weights[l], &float_any};
        snprintf(list[count++].name, sizeof list->name, "weights_%d", l);
        list[count] = (FileFloats){"", 1, {rows}, network->biases[l], &float_any};
        snprintf(list[count++].name, sizeof list->name, "biases_%d", l);
    }
    list[count++] = (FileFloats){"input_offset", 1, {inputs}, network->input.offset, &float_any};
    list[count++] = (FileFloats){"input_scale", 1, {inputs}, network->input.scale, &float_positive};
    list[count++] = (FileFloats){"output_offset", 1, {outputs}, network->output.offset, &float_any};
    list[count++] = (FileFloats){"output_scale", 1, {outputs}, network->output.scale, &float_positive};
    list[count++] = (FileFloats){"output_mean", 1, {outputs}, network->output_mean, &float_any};
    return count;
}

/* "sigmoid linear" */
static void write_activations(const Network *network, char text[ACTIVATIONS_SIZE]) {
    text[0] = '\0';
    for (int l = 0; l < network->layers; l++) {
        if (l > 0) strcat(text, " ");
        strcat(text, activation_names[network->activations[l]]);
    }
}

bool network_write(const Network *network, const char *path, Error *error) {
    const int32_t version = NETWORK_VERSION;
    int32_t widths[NETWORK_MAX_LAYERS + 1];
    for (int l = 0; l <= network->layers; l++) widths[l] = network->widths[l];
    char activations[ACTIVATIONS_SIZE];
    write_activations(network, activations);
    NpzArray arrays[MAX_ARRAYS] = {
        {.name = "version", .type = NPZ_INT32, .data = &version},
        {.name = "kind", .type = NPZ_TEXT, .data = KIND},
        {.name = "inputs", .type = NPZ_TEXT, .data = network->inputs},
        {.name = "outputs", .type = NPZ_TEXT, .data = network->outputs},
        {.name = "target", .type = NPZ_TEXT, .data = network->target},
        {.name = "command", .type = NPZ_TEXT, .data = network->command},
        {.name = "widths", .type = NPZ_INT32, .rank = 1, .shape = {network->layers + 1}, .data = widths},
        {.name = "activations", .type = NPZ_TEXT, .data = activations},
    };
    size_t count = 8;
    FileFloats floats[MAX_FLOATS];
    const int float_count = list_floats(network, floats);
    for (int f = 0; f < float_count; f++) arrays[count++] = file_floats_array(&floats[f]);
    return npz_write(path, arrays, count, error);
}

/* Returns the number of layers and fills widths, or 0 with error set. */
static int read_widths(NpzFile *file, const char *path, int widths[NETWORK_MAX_LAYERS + 1], Error *error) {
    int64_t count;
    if (!npz_shape(file, "widths", NPZ_INT32, 1, &count, error)) return 0;
    if (count < 2 || count > NETWORK_MAX_LAYERS + 1)
        return error_input(error, path, "widths has %lld numbers; expected 2 to %d", (long long)count,
                           NETWORK_MAX_LAYERS + 1);
    int32_t *stored = npz_read(file, "widths", NPZ_INT32, 1, &count, error);
    if (stored == NULL) return 0;
    int bad = -1;
    for (int l = (int)count - 1; l >= 0; l--) {
        widths[l] = stored[l];
        if (widths[l] < 1 || widths[l] > NETWORK_MAX_WIDTH) bad = l;
    }
    free(stored);
    if (bad < 0) return (int)count - 1;
    return error_input(error, path, "widths[%d] is %d; expected 1 to %d", bad, widths[bad], NETWORK_MAX_WIDTH);
}

static bool parse_activation(const char *word, Activation *activation) {
    for (int a = 0; a < ACTIVATION_COUNT; a++) {
        if (strcmp(word, activation_names[a]) != 0) continue;
        *activation = (Activation)a;
        return true;
    }
    return false;
}

static bool read_activations(NpzFile *file, const char *path, Network *network, Error *error) {
    char text[ACTIVATIONS_SIZE], *rest = text;
    if (!npz_read_text(file, "activations", text, sizeof text, error)) return false;
    int count = 0;
    for (char *word; (word = strtok_r(rest, " ", &rest)) != NULL; count++) {
        if (count == network->layers) return error_input(error, path, "more activations than its %d layers", count);
        if (!parse_activation(word, &network->activations[count]))
            return error_input(error, path, "activation %d is unknown; known: linear, sigmoid, tanh, relu", count);
    }
    if (count == network->layers) return true;
    return error_input(error, path, "%d activations for %d layers", count, network->layers);
}

/* Before memory is taken for what only the widths tell. */
static bool expect_contents(const NpzFile *file, int layers, const int *widths, Error *error) {
    Network sizes = {.layers = layers};
    FileFloats floats[MAX_FLOATS];
    memcpy(sizes.widths, widths, (size_t)(layers + 1) * sizeof *widths);
    return file_floats_expect(file, floats, list_floats(&sizes, floats), error);
}

static bool read_contents(NpzFile *file, const char *path, Network *network, Error *error) {
    if (!read_activations(file, path, network, error)) return false;
    FileFloats floats[MAX_FLOATS];
    const int count = list_floats(network, floats);
    return file_floats_read(file, floats, count, error) &&
           npz_read_text(file, "inputs", network->inputs, sizeof network->inputs, error) &&
           npz_read_text(file, "outputs", network->outputs, sizeof network->outputs, error) &&
           npz_read_text(file, "target", network->target, sizeof network->target, error) &&
           npz_read_text(file, "command", network->command, sizeof network->command, error);
}

Network *network_read(const char *path, Error *error) {
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return NULL;
    int widths[NETWORK_MAX_LAYERS + 1];
    Network *network = NULL;
    int layers = npz_check_kind(file, KIND, NETWORK_VERSION, error) ? read_widths(file, path, widths, error) : 0;
    if (layers > 0 && expect_contents(file, layers, widths, error)) network = network_create(layers, widths, error);
    if (network != NULL && !read_contents(file, path, network, error)) {
        network_destroy(network);
        network = NULL;
    }
    npz_close(file);
    return network;
}
