/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Slot networks for tests. */
#pragma once
#include "testing.h"

#include "engine/uniform.h"
#include "nets/kinds.h"

static inline void fill(float *numbers, size_t count, float low, float high, uint32_t *seed) {
    for (size_t i = 0; i < count; i++) numbers[i] = uniform(seed, low, high);
}

static inline void fill_projection(Projection *projection, uint32_t *seed) {
    fill(projection->rows, (size_t)projection->from * (size_t)projection->to, -1, 1, seed);
    fill(projection->centre, (size_t)projection->to, -1, 1, seed);
}

/* Random numbers everywhere; weights so small that no sum of inputs leaves tanh without a slope. */
static inline SceneNet *make_scene_net(const SceneNetShape *shape, const Slot *slots, uint32_t *seed) {
    Error error = {0};
    SceneNet *network = scene_net_create(shape, slots, &error);
    assert_ok(network != NULL, error);
    fill_projection(&network->bomb_state, seed);
    fill_projection(&network->state, seed);
    fill_projection(&network->present, seed);
    fill_projection(&network->warm, seed);
    fill(network->parameters, network->parameter_count, -0.1f, 0.1f, seed);
    fill(network->scale, (size_t)shape->slot_count, 0, 2, seed);
    fill(network->cap, (size_t)shape->slot_count, 0, 2, seed);
    fill(network->low, (size_t)scene_net_inputs(network), -2, -1, seed);
    fill(network->high, (size_t)scene_net_inputs(network), 1, 2, seed);
    scene_net_pack(network);
    return network;
}

/* No step is unlike its training. */
static inline void let_know_all(SceneNet *network) {
    for (int i = 0; i < scene_net_inputs(network); i++) {
        network->low[i] = -1e30f;
        network->high[i] = 1e30f;
    }
}

/* Five bodies. Pairs with no slot before, between and behind those that have some; features up to the largest. */
static const Slot five_slots[] = {{0, 2, 7}, {0, 2, 9},          {0, 4, 0}, {1, 2, 3}, {1, 2, 4},
                                  {1, 2, 5}, {1, 2, UINT32_MAX}, {2, 3, 1}, {2, 4, 7}};
enum { FIVE_SLOTS = sizeof five_slots / sizeof five_slots[0] };
static const SceneNetShape five_shape = {5, 3, FIVE_SLOTS, 16, 32, 48, 64};
