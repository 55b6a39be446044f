/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "network/slot_network.h"

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

bool slot_shape_check(const SlotShape *shape, const Slot *slots, const char *where, Error *error) {
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
