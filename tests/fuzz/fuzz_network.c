/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Readers of trained networks, and of the state of a training. */
#include "fuzz.h"

#include "fuzz_archive.h"
#include "interior_training/net_state.h"
#include "network/momentum_schedule.h"
#include "network/network.h"
#include "network/slot_network.h"

#include <math.h>
#include <stdlib.h>

static void read_network(const char *path) {
    Error error = {0};
    fuzz_begin();
    Network *network = network_read(path, &error);
    fuzz_end(network != NULL, &error, path);
    if (network == NULL) return;
    float *input = calloc((size_t)network->widths[0], sizeof *input);
    float *output = calloc((size_t)network->widths[network->layers], sizeof *output);
    float *scratch = calloc(2 * (size_t)network_scratch_width(network), sizeof *scratch);
    if (input != NULL && output != NULL && scratch != NULL) network_predict(network, input, scratch, output);
    free(input);
    free(output);
    free(scratch);
    network_destroy(network);
}

/* One slot is present, and the bodies are at 0. */
static void predict_slots(const SlotNetwork *network) {
    enum { VALUES = SLOT_BODY_NUMBERS * SLOT_BODIES_MAX };
    static const float zeros[VALUES], ones[1] = {1};
    static float inputs[8 * SLOT_WIDTH_MAX], first[SLOT_WIDTH_MAX], second[SLOT_WIDTH_MAX], outputs[2];
    const int32_t slot = 0, impulses[2] = {0, 1};
    const SlotView view = {.bomb = zeros,
                           .state = zeros,
                           .slot_count = 1,
                           .slots = &slot,
                           .impulses = impulses,
                           .ones = ones,
                           .warm = zeros};
    if (slot_network_inputs(network) > (int)(sizeof inputs / sizeof *inputs)) fuzz_fail("too many inputs");
    slot_network_look(network, &view, inputs);
    slot_network_predict(network, inputs, &view, first, second, outputs);
}

static void read_slot_network(const char *path) {
    Error error = {0};
    fuzz_begin();
    SlotNetwork *network = slot_network_read(path, &error);
    fuzz_end(network != NULL, &error, path);
    if (network != NULL) predict_slots(network);
    slot_network_destroy(network);
}

static void read_schedules(const char *path) {
    MomentumSchedules schedules;
    Error error = {0};
    fuzz_begin();
    const bool ok = momentum_schedules_read(&schedules, path, &error);
    fuzz_end(ok, &error, path);
    if (!ok) return;
    for (int i = 0; i < schedules.count; i++)
        for (int sweep = 0; sweep < schedules.sweeps[i]; sweep++)
            if (!(schedules.factors[i][sweep] >= 0 && schedules.factors[i][sweep] <= MOMENTUM_MAX_FACTOR))
                fuzz_fail("a factor of %g", (double)schedules.factors[i][sweep]);
    momentum_schedules_free(&schedules);
}

static void check_weights(const double *weights, int count) {
    for (int i = 0; i < count; i++)
        if (!isfinite(weights[i])) fuzz_fail("weight %d is NaN or infinite", i);
}

static void read_interior_net(const char *path) {
    InteriorNet net;
    Error error = {0};
    fuzz_begin();
    const bool ok = interior_net_read(&net, path, &error);
    fuzz_end(ok, &error, path);
    if (ok) check_weights(net.weights, INTERIOR_NET_WEIGHTS);
}

/* No error: of another command. */
static void read_state(const char *path) {
    static NetState state;
    Error error = {0};
    fuzz_begin();
    const bool ok = net_state_read(&state, path, "train", &error);
    fuzz_end(ok || error.kind == ERROR_NONE, &error, path);
    if (!ok) return;
    check_weights(state.weights, INTERIOR_NET_WEIGHTS);
    if (state.round < 0 || state.round >= NET_ROUNDS_MAX) fuzz_fail("round %d", (int)state.round);
}

/* The first byte chooses the kind of network. */
void fuzz_network(const uint8_t *data, size_t size) {
    static void (*const readers[])(const char *path) = {read_network, read_slot_network, read_schedules,
                                                        read_interior_net, read_state};
    enum { READERS = sizeof readers / sizeof *readers };
    if (size == 0 || data[0] < 'a' || data[0] >= 'a' + READERS) return;
    readers[data[0] - 'a'](fuzz_archive(data + 1, size - 1));
}
