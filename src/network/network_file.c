/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Network files: .npz with version, kind ("network"), widths[layers + 1], activations (words), weights_L and
   biases_L for every layer, input_offset, input_scale, output_offset, output_scale, output_mean, inputs, outputs,
   target, command. */
#include "network/network.h"

#include "network/file_floats.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
