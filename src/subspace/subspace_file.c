/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Subspace files: .npz with version, kind ("subspace"), scene, command, physics, sizes (bodies, hidden, frames_before),
   predictors (components of each), and as float32, with the shapes of subspace_net.h: rest, basis, low, high, before,
   and of predictor i linear_i, first_rows_i, first_biases_i, second_..., last_.... */
#include "network/file_floats.h"
#include "subspace/subspace_net.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SIZES = 3,
    HEAD_ARRAYS = 7,
    SHARED = 5,
    PER_PREDICTOR = 7,
    FLOATS_MAX = SHARED + PER_PREDICTOR * SUBSPACE_PREDICTORS_MAX
};

static FileFloats *put(FileFloats *at, const char *name, int predictor, int rows, int width, float *numbers) {
    *at = (FileFloats){
        .rank = rows > 0 ? 2 : 1, .shape = {rows > 0 ? rows : width, width}, .numbers = numbers, .range = &float_any};
    if (predictor < 0)
        snprintf(at->name, sizeof at->name, "%s", name);
    else
        snprintf(at->name, sizeof at->name, "%s_%d", name, predictor);
    return at + 1;
}

static FileFloats *put_layer(FileFloats *at, const char *rows, const char *biases, int predictor,
                             const SubspaceLayer *layer) {
    at = put(at, rows, predictor, layer->from, layer->lanes, layer->rows);
    return put(at, biases, predictor, 0, layer->lanes, layer->biases);
}

/* One list for writing and reading; returns its length. */
static int list_floats(const SubspaceNet *net, FileFloats list[FLOATS_MAX]) {
    const SubspaceShape *shape = &net->shape;
    const int lanes = subspace_lanes(SUBSPACE_POSE * shape->bodies);
    FileFloats *at = list;
    at = put(at, "rest", -1, 0, lanes, net->rest);
    at = put(at, "basis", -1, shape->components, lanes, net->basis);
    at = put(at, "low", -1, 0, shape->components, net->low);
    at = put(at, "high", -1, 0, shape->components, net->high);
    at = put(at, "before", -1, 0, 3 * shape->frames_before * (shape->bodies - 1), net->before);
    for (int i = 0; i < shape->predictor_count; i++) {
        const SubspacePredictor *predictor = &net->predictors[i];
        at = put(at, "linear", i, 2, predictor->last.lanes, predictor->linear);
        at = put_layer(at, "first_rows", "first_biases", i, &predictor->first);
        at = put_layer(at, "second_rows", "second_biases", i, &predictor->second);
        at = put_layer(at, "last_rows", "last_biases", i, &predictor->last);
    }
    return (int)(at - list);
}

bool subspace_net_write(const SubspaceNet *net, const char *path, Error *error) {
    const SubspaceShape *shape = &net->shape;
    const int32_t version = SUBSPACE_VERSION, sizes[SIZES] = {shape->bodies, shape->hidden, shape->frames_before};
    int32_t predictors[SUBSPACE_PREDICTORS_MAX];
    for (int i = 0; i < shape->predictor_count; i++) predictors[i] = shape->predictors[i];
    NpzArray arrays[HEAD_ARRAYS + FLOATS_MAX] = {
        {.name = "version", .type = NPZ_INT32, .data = &version},
        {.name = "kind", .type = NPZ_TEXT, .data = SUBSPACE_KIND},
        {.name = "scene", .type = NPZ_TEXT, .data = net->scene},
        {.name = "command", .type = NPZ_TEXT, .data = net->command},
        {.name = "physics", .type = NPZ_UINT64, .data = &net->physics},
        {.name = "sizes", .type = NPZ_INT32, .rank = 1, .shape = {SIZES}, .data = sizes},
        {.name = "predictors", .type = NPZ_INT32, .rank = 1, .shape = {shape->predictor_count}, .data = predictors}};
    FileFloats floats[FLOATS_MAX];
    const int count = list_floats(net, floats);
    for (int i = 0; i < count; i++) arrays[HEAD_ARRAYS + i] = file_floats_array(&floats[i]);
    return npz_write(path, arrays, HEAD_ARRAYS + (size_t)count, error);
}

static bool read_predictors(NpzFile *file, SubspaceShape *shape, Error *error) {
    int64_t count;
    if (!npz_shape(file, "predictors", NPZ_INT32, 1, &count, error)) return false;
    if (count < 1 || count > SUBSPACE_PREDICTORS_MAX)
        return error_input(error, npz_path(file), "predictors has %lld numbers; expected 1 to %d", (long long)count,
                           SUBSPACE_PREDICTORS_MAX);
    int32_t *predictors = npz_read(file, "predictors", NPZ_INT32, 1, &count, error);
    if (predictors == NULL) return false;
    shape->predictor_count = (int)count;
    for (int i = 0; i < shape->predictor_count; i++) shape->components = shape->predictors[i] = predictors[i];
    free(predictors);
    return true;
}

static bool read_shape(NpzFile *file, SubspaceShape *shape, Error *error) {
    const int64_t count = SIZES;
    int32_t *sizes = npz_read(file, "sizes", NPZ_INT32, 1, &count, error);
    if (sizes == NULL) return false;
    *shape = (SubspaceShape){.bodies = sizes[0], .hidden = sizes[1], .frames_before = sizes[2]};
    free(sizes);
    return read_predictors(file, shape, error);
}

/* Clamping needs low <= high. */
static bool check_ranges(const SubspaceNet *net, const char *path, Error *error) {
    for (int k = 0; k < net->shape.components; k++)
        if (net->low[k] > net->high[k])
            return error_input(error, path, "low: number %d is %g, above its high, %g", k, (double)net->low[k],
                               (double)net->high[k]);
    return true;
}

static bool read_contents(NpzFile *file, SubspaceNet *net, Error *error) {
    FileFloats floats[FLOATS_MAX];
    const int count = list_floats(net, floats);
    return file_floats_read(file, floats, count, error) && check_ranges(net, npz_path(file), error) &&
           npz_read_scalar(file, "physics", NPZ_UINT64, &net->physics, sizeof net->physics, error) &&
           npz_read_name(file, "scene", net->scene, sizeof net->scene, error) &&
           npz_read_text(file, "command", net->command, sizeof net->command, error);
}

static bool expect_contents(const NpzFile *file, const SubspaceShape *shape, Error *error) {
    const SubspaceNet sizes = subspace_net_sizes(shape);
    FileFloats floats[FLOATS_MAX];
    return file_floats_expect(file, floats, list_floats(&sizes, floats), error);
}

static SubspaceNet *read_net(NpzFile *file, Error *error) {
    SubspaceShape shape;
    if (!npz_check_kind(file, SUBSPACE_KIND, SUBSPACE_VERSION, error) || !read_shape(file, &shape, error) ||
        !subspace_shape_check(&shape, npz_path(file), error) || !expect_contents(file, &shape, error))
        return NULL;
    SubspaceNet *net = subspace_net_create(&shape, error);
    if (net == NULL || read_contents(file, net, error)) return net;
    subspace_net_destroy(net);
    return NULL;
}

SubspaceNet *subspace_net_read(const char *path, Error *error) {
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return NULL;
    SubspaceNet *net = read_net(file, error);
    npz_close(file);
    return net;
}
