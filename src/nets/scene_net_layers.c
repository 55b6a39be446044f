/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Slot networks: memory, slots, inference, files. */
#include "base/base.h"
#include "base/npz.h"
#include "nets/kernels.h"
#include "nets/kinds.h"
#include "nets/nets.h"

#include <stdlib.h>

static bool widths_are_whole(int width) { return width > 0 && width <= SCENE_NET_WIDTH_MAX && width % ROW_LANES == 0; }

/* ERROR_INPUT, naming `where`, if the shape is out of bounds or the slots are not sorted. */
static bool scene_net_shape_check(const SceneNetShape *shape, const Slot *slots, const char *where, Error *error) {
    if (shape->body_count < 2 || shape->body_count > SCENE_NET_BODIES_MAX || shape->bomb < 0 ||
        shape->bomb >= shape->body_count)
        return error_input(error, where, "%d bodies, of which %d is the bomb", shape->body_count, shape->bomb);
    if (shape->slot_count < 1 || shape->slot_count > SLOTS_MAX)
        return error_input(error, where, "%d slots; expected 1 to %d", shape->slot_count, SLOTS_MAX);
    if (!widths_are_whole(shape->state) || !widths_are_whole(shape->present) || !widths_are_whole(shape->warm) ||
        !widths_are_whole(shape->hidden))
        return error_input(error, where, "a width is not a multiple of %d up to %d", ROW_LANES, SCENE_NET_WIDTH_MAX);
    for (int i = 0; i < shape->slot_count; i++) {
        const Slot *slot = &slots[i];
        bool known = slot->a >= 0 && slot->a < slot->b && slot->b < shape->body_count;
        if (known && i > 0) {
            const Slot *last = &slots[i - 1];
            known = last->a < slot->a || (last->a == slot->a &&
                                          (last->b < slot->b || (last->b == slot->b && last->feature < slot->feature)));
        }
        if (!known) return error_input(error, where, "slot %d has invalid bodies or is not sorted", i);
    }
    return true;
}

/* Takes an array from the block, from a line of the cache on; before there is a block, only counts the bytes. */
static void *take(const SceneNet *network, size_t *used, size_t bytes) {
    char *at = network->block != NULL ? (char *)network->block + *used : NULL;
    *used += (bytes + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE;
    return at;
}

static PackedRows take_packed(const SceneNet *network, size_t *used, int count, int width) {
    return packed_rows_in(take(network, used, packed_rows_bytes(count, width)), count, width);
}

static void take_projection(const SceneNet *network, size_t *used, Projection *projection) {
    const size_t from = (size_t)projection->from, to = (size_t)projection->to;
    projection->rows = take(network, used, from * to * sizeof(float));
    projection->centre = take(network, used, to * sizeof(float));
    projection->packed = take_packed(network, used, projection->from, projection->to);
}

static float *place_layer(SceneNetLayer *layer, float *at) {
    layer->rows = at;
    layer->biases = at != NULL ? at + layer->from * layer->to : NULL;
    return at != NULL ? layer->biases + layer->to : NULL;
}

/* Places all arrays; returns the bytes that they take. */
static size_t lay_out(SceneNet *network) {
    const int inputs = network->first.from, hidden = network->second.to, outputs = 2 * network->slot_count;
    const size_t slots = (size_t)network->slot_count, bodies = (size_t)network->body_count;
    size_t used = 0;
    network->parameter_count =
        (size_t)(inputs + 1) * (size_t)hidden + (size_t)(hidden + 1) * (size_t)(hidden + outputs);
    network->parameters = take(network, &used, network->parameter_count * sizeof(float));
    network->rows = place_layer(&network->second, place_layer(&network->first, network->parameters));
    network->biases = network->rows != NULL ? network->rows + outputs * hidden : NULL;
    network->first.packed = take_packed(network, &used, inputs, hidden);
    network->second.packed = take_packed(network, &used, hidden, hidden);
    network->packed = take_packed(network, &used, outputs, hidden);
    take_projection(network, &used, &network->bomb_state);
    take_projection(network, &used, &network->state);
    take_projection(network, &used, &network->present);
    take_projection(network, &used, &network->warm);
    network->low = take(network, &used, (size_t)inputs * sizeof(float));
    network->high = take(network, &used, (size_t)inputs * sizeof(float));
    network->scale = take(network, &used, slots * sizeof(float));
    network->cap = take(network, &used, slots * sizeof(float));
    network->slots = take(network, &used, slots * sizeof(Slot));
    network->pair_slots = take(network, &used, (bodies * bodies + 1) * sizeof(int32_t));
    return used;
}

/* A network of the shape's sizes without arrays. */
static SceneNet sizes_of(const SceneNetShape *shape) {
    const int slots = shape->slot_count, inputs = ROW_LANES + shape->state + shape->present + shape->warm;
    return (SceneNet){.body_count = shape->body_count,
                      .bomb = shape->bomb,
                      .slot_count = slots,
                      .bomb_state = {.from = SLOT_BODY_NUMBERS, .to = ROW_LANES},
                      .state = {.from = SLOT_BODY_NUMBERS * (shape->body_count - 1), .to = shape->state},
                      .present = {.from = slots, .to = shape->present},
                      .warm = {.from = 2 * slots, .to = shape->warm},
                      .first = {.from = inputs, .to = shape->hidden},
                      .second = {.from = shape->hidden, .to = shape->hidden},
                      .kernels = &kernels_best()->rows};
}

static bool allocate(SceneNet *network, const Slot *slots, Error *error) {
    network->block = calloc(1, lay_out(network));
    if (network->block == NULL) return error_memory(error, "scene-net");
    lay_out(network);
    memcpy(network->slots, slots, (size_t)network->slot_count * sizeof *slots);
    /* The first slot of each pair. */
    const int pairs = network->body_count * network->body_count;
    for (int pair = 0, slot = 0; pair <= pairs; pair++) {
        while (slot < network->slot_count &&
               network->slots[slot].a * network->body_count + network->slots[slot].b < pair)
            slot++;
        network->pair_slots[pair] = slot;
    }
    return true;
}

SceneNet *scene_net_create(const SceneNetShape *shape, const Slot *slots, Error *error) {
    if (!scene_net_shape_check(shape, slots, "scene-net", error)) return NULL;
    SceneNet *network = malloc(sizeof *network);
    if (network == NULL) return error_memory(error, "scene-net"), NULL;
    *network = sizes_of(shape);
    if (!allocate(network, slots, error)) return free(network), NULL;
    return network;
}

void scene_net_destroy(SceneNet *network) {
    if (network == NULL) return;
    free(network->block);
    free(network);
}

int scene_net_find(const SceneNet *network, int a, int b, uint32_t feature) {
    const int32_t *pair = &network->pair_slots[a * network->body_count + b];
    for (int slot = pair[0]; slot < pair[1]; slot++)
        if (network->slots[slot].feature == feature) return slot;
    return -1;
}

void scene_net_pack_layers(SceneNet *network) {
    packed_rows_fill(&network->first.packed, network->first.rows);
    packed_rows_fill(&network->second.packed, network->second.rows);
    packed_rows_fill(&network->packed, network->rows);
}

void scene_net_pack(SceneNet *network) {
    Projection *const projections[] = {&network->bomb_state, &network->state, &network->present, &network->warm};
    for (int i = 0; i < 4; i++) packed_rows_fill(&projections[i]->packed, projections[i]->rows);
    scene_net_pack_layers(network);
}

static float *project(const RowKernels *kernels, const Projection *projection, const int32_t *index,
                      const float *numbers, int count, float *out) {
    for (int i = 0; i < projection->to; i++) out[i] = -projection->centre[i];
    kernels->add(out, &projection->packed, index, numbers, count);
    return out + projection->to;
}

void scene_net_look(const SceneNet *network, const SceneNetView *view, float *inputs) {
    inputs = project(network->kernels, &network->bomb_state, NULL, view->bomb, SLOT_BODY_NUMBERS, inputs);
    inputs = project(network->kernels, &network->state, NULL, view->state, network->state.from, inputs);
    inputs = project(network->kernels, &network->present, view->slots, view->ones, view->slot_count, inputs);
    project(network->kernels, &network->warm, view->impulses, view->warm, 2 * view->slot_count, inputs);
}

static void run_layer(const RowKernels *kernels, const SceneNetLayer *layer, const float *in, float *out) {
    memcpy(out, layer->biases, (size_t)layer->to * sizeof *out);
    kernels->add(out, &layer->packed, NULL, in, layer->from);
    kernels->apply_tanh(out, layer->to);
}

void scene_net_predict(const SceneNet *network, const float *inputs, const SceneNetView *view, float *first,
                       float *second, float *outputs) {
    run_layer(network->kernels, &network->first, inputs, first);
    run_layer(network->kernels, &network->second, first, second);
    network->kernels->multiply(outputs, &network->packed, view->slots, second, view->slot_count);
    for (int i = 0; i < view->slot_count; i++)
        for (int k = 0; k < 2; k++) {
            const int slot = view->slots[i];
            outputs[2 * i + k] = network->scale[slot] * (outputs[2 * i + k] + network->biases[2 * slot + k]);
        }
}

/* Slot network files: kind "scene-net". */

typedef struct SceneNetFile {
    SceneNet *network;
    Slot *slots;      /* of a reader, before the network has them */
    int32_t *columns; /* of a writer: a of all slots, then b, then feature */
} SceneNetFile;

static int list_fields(void *of, NetField *fields) {
    const SceneNetFile *file = of;
    SceneNet *network = file->network;
    const Projection *bomb = &network->bomb_state, *state = &network->state, *present = &network->present,
                     *warm = &network->warm;
    const SceneNetLayer *first = &network->first, *second = &network->second;
    const int slots = network->slot_count;
    int32_t *columns = file->columns;
    const NetField all[] = {
        {"scene", NPZ_TEXT, 0, {sizeof network->scene}, .data = network->scene, .shown = true},
        {"command", NPZ_TEXT, 0, {sizeof network->command}, .data = network->command},
        {"body_count", NPZ_INT32, 0, {0}, .data = &network->body_count, .known = true},
        {"bomb", NPZ_INT32, 0, {0}, .data = &network->bomb, .known = true},
        {"sweeps", NPZ_INT32, 0, {0}, .data = &network->sweeps, .known = true},
        {"slot_a", NPZ_INT32, 1, {slots}, .data = columns, .known = true},
        {"slot_b", NPZ_INT32, 1, {slots}, .data = columns != NULL ? columns + slots : NULL, .known = true},
        {"slot_feature", NPZ_UINT32, 1, {slots}, .data = columns != NULL ? columns + 2 * slots : NULL, .known = true},
        {"bomb_state_rows", NPZ_FLOAT32, 2, {bomb->from, bomb->to}, .data = bomb->rows, .range = &float_any},
        {"bomb_state_centre", NPZ_FLOAT32, 1, {bomb->to}, .data = bomb->centre, .range = &float_any},
        {"state_rows", NPZ_FLOAT32, 2, {state->from, state->to}, .data = state->rows, .range = &float_any},
        {"state_centre", NPZ_FLOAT32, 1, {state->to}, .data = state->centre, .range = &float_any},
        {"present_rows", NPZ_FLOAT32, 2, {present->from, present->to}, .data = present->rows, .range = &float_any},
        {"present_centre", NPZ_FLOAT32, 1, {present->to}, .data = present->centre, .range = &float_any},
        {"warm_rows", NPZ_FLOAT32, 2, {warm->from, warm->to}, .data = warm->rows, .range = &float_any},
        {"warm_centre", NPZ_FLOAT32, 1, {warm->to}, .data = warm->centre, .range = &float_any},
        {"first_rows", NPZ_FLOAT32, 2, {first->from, first->to}, .data = first->rows, .range = &float_any},
        {"first_biases", NPZ_FLOAT32, 1, {first->to}, .data = first->biases, .range = &float_any},
        {"second_rows", NPZ_FLOAT32, 2, {second->from, second->to}, .data = second->rows, .range = &float_any},
        {"second_biases", NPZ_FLOAT32, 1, {second->to}, .data = second->biases, .range = &float_any},
        {"last_rows", NPZ_FLOAT32, 2, {2 * slots, second->to}, .data = network->rows, .range = &float_any},
        {"last_biases", NPZ_FLOAT32, 1, {2 * slots}, .data = network->biases, .range = &float_any},
        {"scale", NPZ_FLOAT32, 1, {slots}, .data = network->scale, .range = &float_not_negative},
        {"cap", NPZ_FLOAT32, 1, {slots}, .data = network->cap, .range = &float_not_negative},
        {"low", NPZ_FLOAT32, 1, {first->from}, .data = network->low, .range = &float_any},
        {"high", NPZ_FLOAT32, 1, {first->from}, .data = network->high, .range = &float_any},
        {"gate", NPZ_FLOAT32, 0, {0}, .data = &network->gate, .range = &float_not_negative},
        {"bomb_inv_mass", NPZ_FLOAT32, 0, {0}, .data = &network->bomb_inv_mass, .range = &float_not_negative},
        {"factors", NPZ_FLOAT32, 1, {network->sweeps}, .data = network->factors, .range = &float_momentum}};
    memcpy(fields, all, sizeof all);
    return sizeof all / sizeof *all;
}

/* The number of columns of a matrix that must have this many rows. */
static bool read_width(NpzFile *file, const char *name, int64_t rows, int *width, Error *error) {
    int64_t shape[2];
    if (!npz_shape(file, name, NPZ_FLOAT32, 2, shape, error)) return false;
    if (shape[0] != rows || shape[1] > SCENE_NET_WIDTH_MAX)
        return error_input(error, npz_path(file), "array '%s' has shape (%lld, %lld); expected (%lld, up to %d)", name,
                           (long long)shape[0], (long long)shape[1], (long long)rows, SCENE_NET_WIDTH_MAX);
    *width = (int)shape[1];
    return true;
}

static bool read_shape(NpzFile *file, SceneNetShape *shape, Error *error) {
    int64_t slots;
    if (!net_file_integer(file, "body_count", &shape->body_count, error) ||
        !net_file_integer(file, "bomb", &shape->bomb, error) || !npz_shape(file, "slot_a", NPZ_INT32, 1, &slots, error))
        return false;
    if (slots > SLOTS_MAX)
        return error_input(error, npz_path(file), "%lld slots; expected 1 to %d", (long long)slots, SLOTS_MAX);
    shape->slot_count = (int)slots;
    return read_width(file, "state_rows", SLOT_BODY_NUMBERS * ((int64_t)shape->body_count - 1), &shape->state, error) &&
           read_width(file, "present_rows", slots, &shape->present, error) &&
           read_width(file, "warm_rows", 2 * slots, &shape->warm, error) &&
           read_width(file, "last_rows", 2 * slots, &shape->hidden, error);
}

static Slot *read_slots(NpzFile *file, int64_t count, Error *error) {
    int32_t *a = npz_read(file, "slot_a", NPZ_INT32, 1, &count, error);
    int32_t *b = a != NULL ? npz_read(file, "slot_b", NPZ_INT32, 1, &count, error) : NULL;
    uint32_t *feature = b != NULL ? npz_read(file, "slot_feature", NPZ_UINT32, 1, &count, error) : NULL;
    Slot *slots = NULL;
    if (feature != NULL && (slots = malloc(((size_t)count + 1) * sizeof *slots)) == NULL)
        error_memory(error, npz_path(file));
    for (int64_t i = 0; slots != NULL && i < count; i++) slots[i] = (Slot){a[i], b[i], feature[i]};
    free(a);
    free(b);
    free(feature);
    return slots;
}

static bool read_sizes(void *of, NpzFile *file, Error *error) {
    SceneNetFile *slot_file = of;
    SceneNetShape shape = {0};
    int sweeps;
    if (!read_shape(file, &shape, error) || !net_file_integer(file, "sweeps", &sweeps, error)) return false;
    if (sweeps < 0 || sweeps > SCENE_NET_SWEEPS_MAX)
        return error_input(error, npz_path(file), "sweeps is %d; expected 0 to %d", sweeps, SCENE_NET_SWEEPS_MAX);
    slot_file->slots = read_slots(file, shape.slot_count, error);
    if (slot_file->slots == NULL || !scene_net_shape_check(&shape, slot_file->slots, npz_path(file), error))
        return false;
    *slot_file->network = sizes_of(&shape);
    slot_file->network->sweeps = sweeps;
    return true;
}

static bool create(void *of, Error *error) {
    const SceneNetFile *file = of;
    return allocate(file->network, file->slots, error);
}

static bool pack(void *of, const char *path, Error *error) {
    (void)path, (void)error;
    scene_net_pack(((SceneNetFile *)of)->network);
    return true;
}

static const NetFileKind kind = {"scene-net", SCENE_NET_NETWORK_VERSION, list_fields, read_sizes, create, pack};

bool scene_net_write(const SceneNet *network, const char *path, Error *error) {
    const size_t count = (size_t)network->slot_count;
    SceneNetFile file = {(SceneNet *)network, NULL, malloc(3 * count * sizeof *file.columns)};
    if (file.columns == NULL) return error_memory(error, path);
    for (size_t i = 0; i < count; i++) {
        file.columns[i] = network->slots[i].a;
        file.columns[count + i] = network->slots[i].b;
        memcpy(&file.columns[2 * count + i], &network->slots[i].feature, sizeof *file.columns);
    }
    const bool ok = net_file_write(&kind, &file, path, error);
    free(file.columns);
    return ok;
}

SceneNet *scene_net_read(const char *path, Error *error) {
    SceneNetFile file = {calloc(1, sizeof *file.network), NULL, NULL};
    if (file.network == NULL) return error_memory(error, path), NULL;
    const bool ok = net_file_read(&kind, &file, path, error);
    free(file.slots);
    if (ok) return file.network;
    scene_net_destroy(file.network);
    return NULL;
}
