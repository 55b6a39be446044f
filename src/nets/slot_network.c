/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/npz.h"
#include "nets/kernels.h"
#include "nets/kinds.h"
#include "nets/nets.h"

#include <stdlib.h>
#include <string.h>

void slot_network_destroy(SlotNetwork *network) {
    if (network == NULL) return;
    Projection *const projections[] = {&network->bomb_state, &network->state, &network->present, &network->warm};
    for (int i = 0; i < 4; i++) {
        free(projections[i]->rows);
        free(projections[i]->centre);
        packed_rows_free(&projections[i]->packed);
    }
    packed_rows_free(&network->first.packed);
    packed_rows_free(&network->second.packed);
    packed_rows_free(&network->packed);
    free(network->slots);
    free(network->scale);
    free(network->cap);
    free(network->low);
    free(network->high);
    free(network->pair_slots);
    free(network->parameters);
    free(network);
}

static bool make_projection(Projection *projection, int from, int to) {
    projection->from = from;
    projection->to = to;
    projection->rows = calloc((size_t)from * (size_t)to, sizeof(float));
    projection->centre = calloc((size_t)to, sizeof(float));
    return packed_rows_make(&projection->packed, from, to) && projection->rows != NULL && projection->centre != NULL;
}

static bool widths_are_whole(int width) { return width > 0 && width <= SLOT_WIDTH_MAX && width % ROW_LANES == 0; }

/* ERROR_INPUT, naming `where`, if the shape is out of bounds or the slots are not sorted. */
static bool slot_shape_check(const SlotShape *shape, const Slot *slots, const char *where, Error *error) {
    if (shape->body_count < 2 || shape->body_count > SLOT_BODIES_MAX || shape->bomb < 0 ||
        shape->bomb >= shape->body_count)
        return error_input(error, where, "%d bodies, of which %d is the bomb", shape->body_count, shape->bomb);
    if (shape->slot_count < 1 || shape->slot_count > SLOTS_MAX)
        return error_input(error, where, "%d slots; expected 1 to %d", shape->slot_count, SLOTS_MAX);
    if (!widths_are_whole(shape->state) || !widths_are_whole(shape->present) || !widths_are_whole(shape->warm) ||
        !widths_are_whole(shape->hidden))
        return error_input(error, where, "a width is not a multiple of %d up to %d", ROW_LANES, SLOT_WIDTH_MAX);
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

/* Layers, rows and biases in one block. */
static bool make_parameters(SlotNetwork *network, const SlotShape *shape) {
    const size_t inputs = (size_t)ROW_LANES + (size_t)shape->state + (size_t)shape->present + (size_t)shape->warm;
    const size_t hidden = (size_t)shape->hidden, outputs = 2 * (size_t)shape->slot_count;
    network->parameter_count = (inputs + 1) * hidden + (hidden + 1) * hidden + (hidden + 1) * outputs;
    float *at = network->parameters = calloc(network->parameter_count, sizeof *at);
    if (at == NULL) return false;
    network->first = (SlotLayer){.from = (int)inputs, .to = (int)hidden, .rows = at, .biases = at + inputs * hidden};
    at += (inputs + 1) * hidden;
    network->second = (SlotLayer){.from = (int)hidden, .to = (int)hidden, .rows = at, .biases = at + hidden * hidden};
    at += (hidden + 1) * hidden;
    network->low = calloc(inputs, sizeof *network->low);
    network->high = calloc(inputs, sizeof *network->high);
    network->rows = at;
    network->biases = at + outputs * hidden;
    return packed_rows_make(&network->first.packed, (int)inputs, (int)hidden) &&
           packed_rows_make(&network->second.packed, (int)hidden, (int)hidden) &&
           packed_rows_make(&network->packed, (int)outputs, (int)hidden) && network->low != NULL &&
           network->high != NULL;
}

/* The first slot of each pair. */
static void index_pairs(SlotNetwork *network) {
    const int pairs = network->body_count * network->body_count;
    for (int pair = 0, slot = 0; pair <= pairs; pair++) {
        while (slot < network->slot_count &&
               network->slots[slot].a * network->body_count + network->slots[slot].b < pair)
            slot++;
        network->pair_slots[pair] = slot;
    }
}

SlotNetwork *slot_network_create(const SlotShape *shape, const Slot *slots, Error *error) {
    if (!slot_shape_check(shape, slots, "slot network", error)) return NULL;
    SlotNetwork *network = calloc(1, sizeof *network);
    const size_t count = (size_t)shape->slot_count, bodies = (size_t)shape->body_count;
    bool ok = network != NULL;
    if (ok) {
        network->kernels = row_kernels_best();
        network->body_count = shape->body_count;
        network->bomb = shape->bomb;
        network->slot_count = shape->slot_count;
        network->slots = malloc(count * sizeof *slots);
        network->scale = calloc(count, sizeof *network->scale);
        network->cap = calloc(count, sizeof *network->cap);
        network->pair_slots = malloc((bodies * bodies + 1) * sizeof *network->pair_slots);
        ok = network->slots != NULL && network->scale != NULL && network->cap != NULL && network->pair_slots != NULL &&
             make_projection(&network->bomb_state, SLOT_BODY_NUMBERS, ROW_LANES) &&
             make_projection(&network->state, SLOT_BODY_NUMBERS * (shape->body_count - 1), shape->state) &&
             make_projection(&network->present, shape->slot_count, shape->present) &&
             make_projection(&network->warm, 2 * shape->slot_count, shape->warm) && make_parameters(network, shape);
    }
    if (ok) {
        memcpy(network->slots, slots, count * sizeof *slots);
        index_pairs(network);
        return network;
    }
    slot_network_destroy(network);
    error_memory(error, "slot network");
    return NULL;
}

int slot_network_find(const SlotNetwork *network, int a, int b, uint32_t feature) {
    const int32_t *pair = &network->pair_slots[a * network->body_count + b];
    for (int slot = pair[0]; slot < pair[1]; slot++)
        if (network->slots[slot].feature == feature) return slot;
    return -1;
}

void slot_network_pack_layers(SlotNetwork *network) {
    packed_rows_fill(&network->first.packed, network->first.rows);
    packed_rows_fill(&network->second.packed, network->second.rows);
    packed_rows_fill(&network->packed, network->rows);
}

void slot_network_pack(SlotNetwork *network) {
    Projection *const projections[] = {&network->bomb_state, &network->state, &network->present, &network->warm};
    for (int i = 0; i < 4; i++) packed_rows_fill(&projections[i]->packed, projections[i]->rows);
    slot_network_pack_layers(network);
}

static float *project(const RowKernels *kernels, const Projection *projection, const int32_t *index,
                      const float *numbers, int count, float *out) {
    for (int i = 0; i < projection->to; i++) out[i] = -projection->centre[i];
    kernels->add(out, &projection->packed, index, numbers, count);
    return out + projection->to;
}

void slot_network_look(const SlotNetwork *network, const SlotView *view, float *inputs) {
    inputs = project(network->kernels, &network->bomb_state, NULL, view->bomb, SLOT_BODY_NUMBERS, inputs);
    inputs = project(network->kernels, &network->state, NULL, view->state, network->state.from, inputs);
    inputs = project(network->kernels, &network->present, view->slots, view->ones, view->slot_count, inputs);
    project(network->kernels, &network->warm, view->impulses, view->warm, 2 * view->slot_count, inputs);
}

static void run_layer(const RowKernels *kernels, const SlotLayer *layer, const float *in, float *out) {
    memcpy(out, layer->biases, (size_t)layer->to * sizeof *out);
    kernels->add(out, &layer->packed, NULL, in, layer->from);
    kernels->apply_tanh(out, layer->to);
}

void slot_network_predict(const SlotNetwork *network, const float *inputs, const SlotView *view, float *first,
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

/* Slot network files: .npz with version, kind ("scene-net"), scene, command, body_count, bomb, sweeps, slot_a, slot_b,
   slot_feature [slots], and as float32, with the shapes of nets/kinds.h: P_rows and P_centre of the projections P =
   bomb_state, state, present, warm; L_rows and L_biases of the layers L = first, second, last; scale, cap, low,
   high, gate, bomb_inv_mass, factors[sweeps]. */

#define KIND "scene-net"

enum { HEAD_ARRAYS = 10, FLOAT_ARRAYS = 21 };

/* One list for writing and reading. */
static void list_floats(SlotNetwork *network, FileFloats list[FLOAT_ARRAYS]) {
    const Projection *bomb = &network->bomb_state, *state = &network->state, *present = &network->present,
                     *warm = &network->warm;
    const SlotLayer *first = &network->first, *second = &network->second;
    const int slots = network->slot_count;
    const FileFloats all[FLOAT_ARRAYS] = {
        {"bomb_state_rows", 2, {bomb->from, bomb->to}, bomb->rows, &float_any},
        {"bomb_state_centre", 1, {bomb->to}, bomb->centre, &float_any},
        {"state_rows", 2, {state->from, state->to}, state->rows, &float_any},
        {"state_centre", 1, {state->to}, state->centre, &float_any},
        {"present_rows", 2, {present->from, present->to}, present->rows, &float_any},
        {"present_centre", 1, {present->to}, present->centre, &float_any},
        {"warm_rows", 2, {warm->from, warm->to}, warm->rows, &float_any},
        {"warm_centre", 1, {warm->to}, warm->centre, &float_any},
        {"first_rows", 2, {first->from, first->to}, first->rows, &float_any},
        {"first_biases", 1, {first->to}, first->biases, &float_any},
        {"second_rows", 2, {second->from, second->to}, second->rows, &float_any},
        {"second_biases", 1, {second->to}, second->biases, &float_any},
        {"last_rows", 2, {2 * slots, second->to}, network->rows, &float_any},
        {"last_biases", 1, {2 * slots}, network->biases, &float_any},
        {"scale", 1, {slots}, network->scale, &float_not_negative},
        {"cap", 1, {slots}, network->cap, &float_not_negative},
        {"low", 1, {first->from}, network->low, &float_any},
        {"high", 1, {first->from}, network->high, &float_any},
        {"gate", 0, {0}, &network->gate, &float_not_negative},
        {"bomb_inv_mass", 0, {0}, &network->bomb_inv_mass, &float_not_negative},
        {"factors", 1, {network->sweeps}, network->factors, &float_momentum},
    };
    memcpy(list, all, sizeof all);
}

/* a of all slots, then b, then feature; NULL when memory is short. */
static int32_t *slot_columns(const SlotNetwork *network) {
    const int count = network->slot_count;
    int32_t *columns = malloc(3 * (size_t)count * sizeof *columns);
    for (int i = 0; columns != NULL && i < count; i++) {
        columns[i] = network->slots[i].a;
        columns[count + i] = network->slots[i].b;
        memcpy(&columns[2 * count + i], &network->slots[i].feature, sizeof *columns);
    }
    return columns;
}

bool slot_network_write(const SlotNetwork *network, const char *path, Error *error) {
    const int32_t version = SLOT_NETWORK_VERSION, body_count = network->body_count, bomb = network->bomb,
                  sweeps = network->sweeps, count = network->slot_count;
    int32_t *slots = slot_columns(network);
    if (slots == NULL) return error_memory(error, path);
    NpzArray arrays[HEAD_ARRAYS + FLOAT_ARRAYS] = {
        {.name = "version", .type = NPZ_INT32, .data = &version},
        {.name = "kind", .type = NPZ_TEXT, .data = KIND},
        {.name = "scene", .type = NPZ_TEXT, .data = network->scene},
        {.name = "command", .type = NPZ_TEXT, .data = network->command},
        {.name = "body_count", .type = NPZ_INT32, .data = &body_count},
        {.name = "bomb", .type = NPZ_INT32, .data = &bomb},
        {.name = "sweeps", .type = NPZ_INT32, .data = &sweeps},
        {.name = "slot_a", .type = NPZ_INT32, .rank = 1, .shape = {count}, .data = slots},
        {.name = "slot_b", .type = NPZ_INT32, .rank = 1, .shape = {count}, .data = slots + count},
        {.name = "slot_feature", .type = NPZ_UINT32, .rank = 1, .shape = {count}, .data = slots + 2 * count},
    };
    SlotNetwork copy = *network; /* the list has pointers that are not const */
    FileFloats floats[FLOAT_ARRAYS];
    list_floats(&copy, floats);
    for (int i = 0; i < FLOAT_ARRAYS; i++) arrays[HEAD_ARRAYS + i] = file_floats_array(&floats[i]);
    bool ok = npz_write(path, arrays, HEAD_ARRAYS + FLOAT_ARRAYS, error);
    free(slots);
    return ok;
}

static bool read_int(NpzFile *file, const char *name, int *number, Error *error) {
    int32_t stored;
    if (!npz_read_scalar(file, name, NPZ_INT32, &stored, sizeof stored, error)) return false;
    *number = stored;
    return true;
}

/* The number of columns of a matrix that must have this many rows. Memory is allocated only for what the file holds. */
static bool read_width(NpzFile *file, const char *name, int64_t rows, int *width, Error *error) {
    int64_t shape[2];
    if (!npz_shape(file, name, NPZ_FLOAT32, 2, shape, error)) return false;
    if (shape[0] != rows || shape[1] > SLOT_WIDTH_MAX)
        return error_input(error, npz_path(file), "array '%s' has shape (%lld, %lld); expected (%lld, up to %d)", name,
                           (long long)shape[0], (long long)shape[1], (long long)rows, SLOT_WIDTH_MAX);
    *width = (int)shape[1];
    return true;
}

static bool read_shape(NpzFile *file, SlotShape *shape, Error *error) {
    int64_t slots;
    if (!read_int(file, "body_count", &shape->body_count, error) || !read_int(file, "bomb", &shape->bomb, error) ||
        !npz_shape(file, "slot_a", NPZ_INT32, 1, &slots, error))
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

static bool read_contents(NpzFile *file, SlotNetwork *network, Error *error) {
    if (!npz_read_name(file, "scene", network->scene, sizeof network->scene, error) ||
        !npz_read_text(file, "command", network->command, sizeof network->command, error) ||
        !read_int(file, "sweeps", &network->sweeps, error))
        return false;
    if (network->sweeps < 0 || network->sweeps > SLOT_SWEEPS_MAX)
        return error_input(error, npz_path(file), "sweeps is %d; expected 0 to %d", network->sweeps, SLOT_SWEEPS_MAX);
    FileFloats floats[FLOAT_ARRAYS];
    list_floats(network, floats);
    if (!file_floats_read(file, floats, FLOAT_ARRAYS, error)) return false;
    slot_network_pack(network);
    return true;
}

/* All but the factors, before memory is taken for what only the widths tell. */
static bool expect_contents(const NpzFile *file, const SlotShape *shape, Error *error) {
    const int slots = shape->slot_count, inputs = ROW_LANES + shape->state + shape->present + shape->warm;
    SlotNetwork sizes = {.slot_count = slots,
                         .bomb_state = {.from = SLOT_BODY_NUMBERS, .to = ROW_LANES},
                         .state = {.from = SLOT_BODY_NUMBERS * (shape->body_count - 1), .to = shape->state},
                         .present = {.from = slots, .to = shape->present},
                         .warm = {.from = 2 * slots, .to = shape->warm},
                         .first = {.from = inputs, .to = shape->hidden},
                         .second = {.from = shape->hidden, .to = shape->hidden}};
    FileFloats floats[FLOAT_ARRAYS];
    list_floats(&sizes, floats);
    return file_floats_expect(file, floats, FLOAT_ARRAYS - 1, error);
}

static SlotNetwork *read_network(NpzFile *file, Error *error) {
    SlotShape shape = {0};
    if (!npz_check_kind(file, KIND, SLOT_NETWORK_VERSION, error) || !read_shape(file, &shape, error)) return NULL;
    Slot *slots = read_slots(file, shape.slot_count, error);
    SlotNetwork *network = NULL;
    if (slots != NULL && slot_shape_check(&shape, slots, npz_path(file), error) && expect_contents(file, &shape, error))
        network = slot_network_create(&shape, slots, error);
    free(slots);
    if (network == NULL || read_contents(file, network, error)) return network;
    slot_network_destroy(network);
    return NULL;
}

SlotNetwork *slot_network_read(const char *path, Error *error) {
    NpzFile *file = npz_open(path, error);
    if (file == NULL) return NULL;
    SlotNetwork *network = read_network(file, error);
    npz_close(file);
    return network;
}
