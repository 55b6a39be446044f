/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Subspace networks: memory, files, and steps in the subspace. */
#include "base/base.h"
#include "base/npz.h"
#include "nets/kernels.h"
#include "nets/kinds.h"
#include "nets/nets.h"

#include <stdio.h>
#include <stdlib.h>

enum { POSE = 3 }; /* x, y, angle */

bool subspace_shape_check(const SubspaceShape *shape, const char *where, Error *error) {
    bool ok = shape->bodies >= 1 && shape->bodies <= SUBSPACE_BODIES_MAX && shape->hidden >= ROW_LANES &&
              shape->hidden <= SUBSPACE_HIDDEN_MAX && shape->hidden % ROW_LANES == 0 && shape->frames_before >= 0 &&
              shape->frames_before <= SUBSPACE_FRAMES_MAX && shape->predictor_count >= 1 &&
              shape->predictor_count <= SUBSPACE_PREDICTORS_MAX && shape->components >= 1 &&
              shape->components <= SUBSPACE_COMPONENTS_MAX && shape->components <= SUBSPACE_POSE * shape->bodies;
    for (int i = 0; ok && i < shape->predictor_count; i++)
        ok = shape->predictors[i] > (i > 0 ? shape->predictors[i - 1] : 0);
    ok = ok && shape->predictors[shape->predictor_count - 1] == shape->components;
    return ok ||
           error_input(error, where,
                       "%d bodies, %d components, %d hidden units, %d frames and %d predictors "
                       "are out of bounds or do not fit together",
                       shape->bodies, shape->components, shape->hidden, shape->frames_before, shape->predictor_count);
}

/* Takes `count` numbers from the block; before there is one, only counts them. */
static float *take(SubspaceNet *net, size_t *used, size_t count) {
    float *at = net->block != NULL ? net->block + *used : NULL;
    *used += count;
    return at;
}

static SubspaceLayer take_layer(SubspaceNet *net, size_t *used, int from, int to) {
    const size_t lanes = (size_t)subspace_lanes(to);
    return (SubspaceLayer){from, (int)lanes, take(net, used, (size_t)from * lanes), take(net, used, lanes)};
}

static size_t lay_out(SubspaceNet *net) {
    const SubspaceShape *shape = &net->shape;
    const size_t numbers = (size_t)subspace_lanes(SUBSPACE_POSE * shape->bodies),
                 components = (size_t)shape->components;
    size_t used = 0;
    net->rest = take(net, &used, numbers);
    net->basis = take(net, &used, components * numbers);
    net->low = take(net, &used, components);
    net->high = take(net, &used, components);
    net->before = take(net, &used, (size_t)shape->frames_before * (size_t)(shape->bodies - 1) * POSE);
    for (int i = 0; i < shape->predictor_count; i++) {
        SubspacePredictor *predictor = &net->predictors[i];
        const int count = predictor->components = shape->predictors[i];
        predictor->linear = take(net, &used, 2 * (size_t)subspace_lanes(count));
        predictor->first = take_layer(net, &used, 2 * count + SUBSPACE_LAUNCH, shape->hidden);
        predictor->second = take_layer(net, &used, shape->hidden, shape->hidden);
        predictor->last = take_layer(net, &used, shape->hidden, count);
    }
    return used;
}

/* The shape is set. */
static bool allocate(void *of, Error *error) {
    SubspaceNet *net = of;
    net->block = calloc(lay_out(net), sizeof *net->block);
    if (net->block == NULL) return error_memory(error, "subspace");
    lay_out(net);
    return true;
}

SubspaceNet *subspace_net_create(const SubspaceShape *shape, Error *error) {
    SubspaceNet *net = calloc(1, sizeof *net);
    if (net == NULL) return error_memory(error, "subspace"), NULL;
    net->shape = *shape;
    if (!allocate(net, error)) return free(net), NULL;
    return net;
}

void subspace_net_destroy(SubspaceNet *net) {
    if (net == NULL) return;
    free(net->block);
    free(net);
}

const SubspacePredictor *subspace_net_choose(const SubspaceNet *net, int components) {
    int chosen = 0;
    for (int i = 1; i < net->shape.predictor_count; i++)
        if (net->predictors[i].components <= components) chosen = i;
    return &net->predictors[chosen];
}

/* Subspace files: kind SUBSPACE_KIND; predictor i has linear_i, first_rows_i, first_biases_i, second_..., last_.... */

enum { SIZES = 3 }; /* bodies, hidden, frames_before */

static NetField *put(NetField *at, const char *name, int predictor, int rows, int width, float *numbers) {
    *at = (NetField){.type = NPZ_FLOAT32,
                     .rank = rows > 0 ? 2 : 1,
                     .shape = {rows > 0 ? rows : width, width},
                     .data = numbers,
                     .range = &float_any};
    if (predictor < 0)
        snprintf(at->name, sizeof at->name, "%s", name);
    else
        snprintf(at->name, sizeof at->name, "%s_%d", name, predictor);
    return at + 1;
}

static NetField *put_layer(NetField *at, const char *rows, const char *biases, int predictor,
                           const SubspaceLayer *layer) {
    at = put(at, rows, predictor, layer->from, layer->lanes, layer->rows);
    return put(at, biases, predictor, 0, layer->lanes, layer->biases);
}

static int list_fields(void *of, NetField *fields) {
    SubspaceNet *net = of;
    SubspaceShape *shape = &net->shape;
    const int lanes = subspace_lanes(SUBSPACE_POSE * shape->bodies);
    const NetField first[] = {
        {"scene", NPZ_TEXT, 0, {sizeof net->scene}, .data = net->scene, .shown = true},
        {"command", NPZ_TEXT, 0, {sizeof net->command}, .data = net->command},
        {"physics", NPZ_UINT64, 0, {0}, .data = &net->physics},
        {"sizes", NPZ_INT32, 1, {SIZES}, .data = shape, .known = true},
        {"predictors", NPZ_INT32, 1, {shape->predictor_count}, .data = shape->predictors, .known = true}};
    NetField *at = fields + sizeof first / sizeof *first;
    memcpy(fields, first, sizeof first);
    at = put(at, "rest", -1, 0, lanes, net->rest);
    at = put(at, "basis", -1, shape->components, lanes, net->basis);
    at = put(at, "low", -1, 0, shape->components, net->low);
    at = put(at, "high", -1, 0, shape->components, net->high);
    at = put(at, "before", -1, 0, POSE * shape->frames_before * (shape->bodies - 1), net->before);
    for (int i = 0; i < shape->predictor_count; i++) {
        const SubspacePredictor *predictor = &net->predictors[i];
        at = put(at, "linear", i, 2, predictor->last.lanes, predictor->linear);
        at = put_layer(at, "first_rows", "first_biases", i, &predictor->first);
        at = put_layer(at, "second_rows", "second_biases", i, &predictor->second);
        at = put_layer(at, "last_rows", "last_biases", i, &predictor->last);
    }
    return (int)(at - fields);
}

static bool read_sizes(void *of, NpzFile *file, Error *error) {
    SubspaceNet *net = of;
    SubspaceShape *shape = &net->shape;
    int32_t sizes[SIZES];
    if (net_file_integers(file, "sizes", SIZES, SIZES, sizes, error) == 0) return false;
    *shape = (SubspaceShape){.bodies = sizes[0], .hidden = sizes[1], .frames_before = sizes[2]};
    shape->predictor_count =
        net_file_integers(file, "predictors", 1, SUBSPACE_PREDICTORS_MAX, shape->predictors, error);
    if (shape->predictor_count == 0) return false;
    shape->components = shape->predictors[shape->predictor_count - 1];
    if (!subspace_shape_check(shape, npz_path(file), error)) return false;
    lay_out(net); /* the sizes of all arrays */
    return true;
}

/* Clamping needs low <= high. */
static bool check_ranges(void *of, const char *path, Error *error) {
    const SubspaceNet *net = of;
    for (int k = 0; k < net->shape.components; k++)
        if (net->low[k] > net->high[k])
            return error_input(error, path, "low: number %d is %g, above its high, %g", k, (double)net->low[k],
                               (double)net->high[k]);
    return true;
}

static const NetFileKind kind = {SUBSPACE_KIND, SUBSPACE_VERSION, list_fields, read_sizes, allocate, check_ranges};

bool subspace_net_write(const SubspaceNet *net, const char *path, Error *error) {
    return net_file_write(&kind, net, path, error);
}

SubspaceNet *subspace_net_read(const char *path, Error *error) {
    SubspaceNet *net = calloc(1, sizeof *net);
    if (net == NULL) return error_memory(error, path), NULL;
    if (net_file_read(&kind, net, path, error)) return net;
    subspace_net_destroy(net);
    return NULL;
}

bool subspace_make(Subspace *subspace, const SubspaceNet *net, const SubspacePredictor *predictor, bool corrects,
                   Error *error) {
    const size_t lanes = (size_t)predictor->last.lanes, hidden = (size_t)net->shape.hidden,
                 numbers = (size_t)subspace_lanes(SUBSPACE_POSE * net->shape.bodies);
    *subspace = (Subspace){.net = net, .predictor = predictor, .kernels = &kernels_best()->rows, .corrects = corrects};
    float *at = calloc(3 * lanes + (size_t)predictor->first.from + 2 * hidden + numbers, sizeof *at);
    if (at == NULL) return error_memory(error, "subspace");
    subspace->numbers = at;
    subspace->now = at += numbers;
    subspace->last = at += lanes;
    subspace->next = at += lanes;
    subspace->first = at += lanes;
    subspace->second = at += hidden;
    subspace->inputs = at + hidden;
    return true;
}

void subspace_free(Subspace *subspace) {
    free(subspace->numbers);
    *subspace = (Subspace){0};
}

float subspace_component(const SubspaceNet *net, const float *numbers, int k) {
    const int count = SUBSPACE_POSE * net->shape.bodies;
    const float *row = net->basis + (size_t)k * (size_t)subspace_lanes(count);
    double sum = 0;
    for (int j = 0; j < count; j++) sum += (double)row[j] * ((double)numbers[j] - (double)net->rest[j]);
    return (float)sum;
}

void subspace_start(Subspace *subspace, const float *last, const float *now) {
    for (int k = 0; k < subspace->predictor->components; k++) {
        subspace->last[k] = subspace_component(subspace->net, last, k);
        subspace->now[k] = subspace_component(subspace->net, now, k);
    }
}

static void run_layer(const RowKernels *kernels, const SubspaceLayer *layer, const float *in, float *out) {
    memcpy(out, layer->biases, (size_t)layer->lanes * sizeof *out);
    kernels->combine(out, layer->rows, layer->lanes, in, layer->from);
}

/* next += N(...) */
static void correct(Subspace *subspace, const float launch[SUBSPACE_LAUNCH]) {
    const SubspacePredictor *predictor = subspace->predictor;
    const RowKernels *kernels = subspace->kernels;
    const int components = predictor->components, hidden = subspace->net->shape.hidden;
    float *inputs = subspace->inputs;
    for (int k = 0; k < components; k++) {
        inputs[k] = subspace->now[k];
        inputs[components + k] = subspace->now[k] - subspace->last[k];
    }
    memcpy(inputs + 2 * components, launch, SUBSPACE_LAUNCH * sizeof *launch);
    run_layer(kernels, &predictor->first, inputs, subspace->first);
    kernels->apply_tanh(subspace->first, hidden);
    run_layer(kernels, &predictor->second, subspace->first, subspace->second);
    kernels->apply_tanh(subspace->second, hidden);
    run_layer(kernels, &predictor->last, subspace->second, subspace->next);
}

SubspaceReport subspace_step(Subspace *subspace, const float launch[SUBSPACE_LAUNCH]) {
    const SubspacePredictor *predictor = subspace->predictor;
    const float *a = predictor->linear, *b = a + predictor->last.lanes, *low = subspace->net->low,
                *high = subspace->net->high;
    float *next = subspace->next;
    SubspaceReport report = {0, 0};
    if (subspace->corrects)
        correct(subspace, launch);
    else
        memset(next, 0, (size_t)predictor->last.lanes * sizeof *next);
    for (int k = 0; k < predictor->components; k++) {
        const float z = (a[k] * subspace->now[k] + b[k] * subspace->last[k]) + next[k];
        const bool finite = isfinite(z);
        const float kept = finite ? z : subspace->now[k];
        report.not_finite += !finite;
        report.beyond += finite && (z < low[k] || z > high[k]);
        next[k] = kept < low[k] ? low[k] : kept > high[k] ? high[k] : kept;
    }
    subspace->next = subspace->last;
    subspace->last = subspace->now;
    subspace->now = next;
    return report;
}

void subspace_reconstruct(Subspace *subspace) {
    const SubspaceNet *net = subspace->net;
    const int lanes = subspace_lanes(SUBSPACE_POSE * net->shape.bodies);
    memcpy(subspace->numbers, net->rest, (size_t)lanes * sizeof *subspace->numbers);
    subspace->kernels->combine(subspace->numbers, net->basis, lanes, subspace->now, subspace->predictor->components);
}
