/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Readers of trained networks. */
#include "fuzz.h"

#include "fuzz_archive.h"
#include "methods/hybrid_memory.h"
#include "methods/sain.h"
#include "nets/kinds.h"
#include "nets/nets.h"

#include <math.h>
#include <stdlib.h>

static void read_network(const char *path) {
    Error error = {0};
    Network *network = FUZZ_READ(network_read(path, &error), path);
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
static void predict_slots(const SceneNet *network) {
    enum { VALUES = SLOT_BODY_NUMBERS * SCENE_NET_BODIES_MAX };
    static const float zeros[VALUES], ones[1] = {1};
    static float inputs[8 * SCENE_NET_WIDTH_MAX], first[SCENE_NET_WIDTH_MAX], second[SCENE_NET_WIDTH_MAX], outputs[2];
    const int32_t slot = 0, impulses[2] = {0, 1};
    const SceneNetView view = {.bomb = zeros,
                               .state = zeros,
                               .slot_count = 1,
                               .slots = &slot,
                               .impulses = impulses,
                               .ones = ones,
                               .warm = zeros};
    if (scene_net_inputs(network) > (int)(sizeof inputs / sizeof *inputs)) fuzz_fail("too many inputs");
    scene_net_look(network, &view, inputs);
    scene_net_predict(network, inputs, &view, first, second, outputs);
}

static void read_slot_network(const char *path) {
    Error error = {0};
    SceneNet *network = FUZZ_READ(scene_net_read(path, &error), path);
    if (network != NULL) predict_slots(network);
    scene_net_destroy(network);
}

static void read_gns_net(const char *path) {
    GnsNet net;
    Error error = {0};
    const bool ok = FUZZ_READ(gns_net_read(&net, path, &error), path);
    for (int i = 0; ok && i < net.layout.parameters; i++)
        if (!isfinite(net.parameters[i])) fuzz_fail("parameter %d is NaN or infinite", i);
    gns_net_free(&net);
}

/* Each entry answers its own key with finite impulses. */
static void read_memory(const char *path) {
    static ContactImpulse impulses[HYBRID_CONTACTS_MAX];
    Error error = {0};
    HybridMemory *memory = FUZZ_READ(hybrid_memory_read(path, &error), path);
    for (int entry = 0; memory != NULL && entry < memory->entry_count; entry++) {
        const int set = memory->entry_set[entry];
        const float *key = memory->keys + (size_t)entry * (size_t)memory->key_size;
        const HybridQuery query = {memory->set_hash[set], memory->set_contacts[set], key};
        if (hybrid_memory_find(memory, &query) < 0) continue; /* a metric may be anything */
        hybrid_memory_answer(memory, entry, key, impulses);
        hybrid_memory_stretch(memory, entry, key);
    }
    hybrid_memory_destroy(memory);
}

/* Asked about one receiver with one sender, both at 0. */
static void read_sain(const char *path) {
    SainNetwork network;
    Error error = {0};
    const bool ok = FUZZ_READ(sain_network_read(&network, path, &error), path);
    if (!ok) return;
    float pair[SAIN_PAIR_INPUTS] = {0}, inputs[SAIN_BODY_INPUTS] = {0};
    SainBody body = {.rows = 1, .axis = {1, 0}, .radius = 1};
    SainView view = {.body_count = 1, .row_count = 1, .bodies = &body, .pair_inputs = pair, .body_inputs = inputs};
    SainAnswers answers = {0};
    if (!sain_answer(&answers, &network, &view)) fuzz_fail("memory");
    sain_answers_free(&answers);
    sain_network_destroy(&network);
}

/* Steps from a state of zeros: what follows is finite and in range. */
static void step_subspace(const SubspaceNet *net, const SubspacePredictor *predictor) {
    static const float zeros[SUBSPACE_POSE * SUBSPACE_BODIES_MAX], launch[SUBSPACE_LAUNCH] = {1, 0, 0, 50};
    Subspace subspace;
    Error error = {0};
    if (!subspace_make(&subspace, net, predictor, true, &error)) return;
    subspace_start(&subspace, zeros, zeros);
    for (int step = 0; step < 3; step++) {
        subspace_step(&subspace, launch);
        for (int k = 0; k < predictor->components; k++)
            if (!isfinite(subspace.now[k])) fuzz_fail("component %d is not finite", k);
    }
    subspace_reconstruct(&subspace);
    subspace_free(&subspace);
}

static void read_subspace(const char *path) {
    Error error = {0};
    SubspaceNet *net = FUZZ_READ(subspace_net_read(path, &error), path);
    if (net == NULL) return;
    for (int i = 0; i < net->shape.predictor_count; i++) step_subspace(net, &net->predictors[i]);
    subspace_net_destroy(net);
}

/* The first byte chooses the kind of network. */
void fuzz_network(const uint8_t *data, size_t size) {
    static void (*const readers[])(const char *path) = {read_network, read_slot_network, read_gns_net,
                                                        read_memory,  read_sain,         read_subspace};
    enum { READERS = sizeof readers / sizeof *readers };
    if (size == 0 || data[0] < 'a' || data[0] >= 'a' + READERS) return;
    readers[data[0] - 'a'](fuzz_archive(data + 1, size - 1));
}
