/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Network files: .npz with version, kind ("network"), widths[layers + 1], activations (words), weights_L and
   biases_L for every layer, input_offset, input_scale, output_offset, output_scale, output_mean, inputs, outputs,
   target, command. */
#include "network/network.h"

#include "common/npz.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define KIND "network"

enum { ACTIVATIONS_SIZE = 256, MAX_ARRAYS = 13 + 2 * NETWORK_MAX_LAYERS };

static const char *const activation_names[] = {[ACTIVATION_LINEAR] = "linear",
                                               [ACTIVATION_SIGMOID] = "sigmoid",
                                               [ACTIVATION_TANH] = "tanh",
                                               [ACTIVATION_RELU] = "relu"};

enum { ACTIVATION_COUNT = sizeof activation_names / sizeof activation_names[0] };

/* The arrays of float32 numbers of a network, by name; the same list serves writing and reading. */
typedef struct Member {
    char name[24];
    int rank;
    int64_t shape[2];
    float *numbers;
} Member;

enum { MAX_MEMBERS = 2 * NETWORK_MAX_LAYERS + 5 };

static int list_members(const Network *network, Member members[MAX_MEMBERS]) {
    int count = 0, inputs = network->widths[0], outputs = network->widths[network->layers];
    for (int l = 0; l < network->layers; l++) {
        int rows = network->widths[l + 1], columns = network->widths[l];
        members[count] = (Member){.rank = 2, .shape = {rows, columns}, .numbers = network->weights[l]};
        snprintf(members[count++].name, sizeof members->name, "weights_%d", l);
        members[count] = (Member){.rank = 1, .shape = {rows}, .numbers = network->biases[l]};
        snprintf(members[count++].name, sizeof members->name, "biases_%d", l);
    }
    members[count++] = (Member){"input_offset", 1, {inputs}, network->input.offset};
    members[count++] = (Member){"input_scale", 1, {inputs}, network->input.scale};
    members[count++] = (Member){"output_offset", 1, {outputs}, network->output.offset};
    members[count++] = (Member){"output_scale", 1, {outputs}, network->output.scale};
    members[count++] = (Member){"output_mean", 1, {outputs}, network->output_mean};
    return count;
}

static size_t member_size(const Member *member) {
    return (size_t)member->shape[0] * (size_t)(member->rank == 2 ? member->shape[1] : 1);
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
    Member members[MAX_MEMBERS];
    int member_count = list_members(network, members);
    for (int m = 0; m < member_count; m++)
        arrays[count++] = (NpzArray){.name = members[m].name,
                                     .type = NPZ_FLOAT32,
                                     .rank = members[m].rank,
                                     .shape = {members[m].shape[0], members[m].shape[1]},
                                     .data = members[m].numbers};
    return npz_write(path, arrays, count, error);
}

static bool check_version(NpzFile *file, const char *path, Error *error) {
    char kind[32] = "";
    if (!npz_has(file, "kind") || !npz_read_text(file, "kind", kind, sizeof kind, error) || strcmp(kind, KIND) != 0)
        return error_input(error, path, "holds no network");
    int32_t *version = npz_read(file, "version", NPZ_INT32, 0, NULL, error);
    if (version == NULL) return false;
    int32_t found = *version;
    free(version);
    if (found == NETWORK_VERSION) return true;
    return error_input(error, path, "network of version %d; this program reads version %d", found, NETWORK_VERSION);
}

/* Returns the number of layers and fills widths, or 0 with error set. */
static int read_widths(NpzFile *file, const char *path, int widths[NETWORK_MAX_LAYERS + 1], Error *error) {
    int64_t count;
    if (!npz_shape(file, "widths", NPZ_INT32, 1, &count, error)) return 0;
    if (count < 2 || count > NETWORK_MAX_LAYERS + 1)
        return error_input(error, path, "widths has %lld numbers; 2 to %d are possible", (long long)count,
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
    return error_input(error, path, "widths[%d] is %d; 1 to %d are possible", bad, widths[bad], NETWORK_MAX_WIDTH);
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
            return error_input(error, path, "activation %d is none of linear, sigmoid, tanh and relu", count);
    }
    if (count == network->layers) return true;
    return error_input(error, path, "%d activations for %d layers", count, network->layers);
}

static bool read_member(NpzFile *file, const char *path, const Member *member, Error *error) {
    float *numbers = npz_read(file, member->name, NPZ_FLOAT32, member->rank, member->shape, error);
    if (numbers == NULL) return false;
    size_t size = member_size(member), i = 0;
    bool is_scale = strstr(member->name, "scale") != NULL;
    while (i < size && isfinite(numbers[i]) && !(is_scale && numbers[i] <= 0)) i++;
    if (i == size)
        memcpy(member->numbers, numbers, size * sizeof *numbers);
    else
        error_input(error, path, "%s: number %zu is %g; it must be finite%s", member->name, i, (double)numbers[i],
                    is_scale ? " and greater than 0" : "");
    free(numbers);
    return i == size;
}

static bool read_contents(NpzFile *file, const char *path, Network *network, Error *error) {
    if (!read_activations(file, path, network, error)) return false;
    Member members[MAX_MEMBERS];
    int count = list_members(network, members);
    for (int m = 0; m < count; m++)
        if (!read_member(file, path, &members[m], error)) return false;
    return npz_read_text(file, "inputs", network->inputs, sizeof network->inputs, error) &&
           npz_read_text(file, "outputs", network->outputs, sizeof network->outputs, error) &&
           npz_read_text(file, "target", network->target, sizeof network->target, error) &&
           npz_read_text(file, "command", network->command, sizeof network->command, error);
}

Network *network_read(const char *path, Error *error) {
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return NULL;
    int widths[NETWORK_MAX_LAYERS + 1];
    Network *network = NULL;
    int layers = check_version(file, path, error) ? read_widths(file, path, widths, error) : 0;
    if (layers > 0) network = network_create(layers, widths, error);
    if (network != NULL && !read_contents(file, path, network, error)) {
        network_destroy(network);
        network = NULL;
    }
    npz_close(file);
    return network;
}
