/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A network of sain with any weights, which knows all states. */
#pragma once
#include "testing.h"

#include "engine/uniform.h"
#include "methods/sain.h"

#include <float.h>

static inline void let_know_everything(SainNetwork *network) {
    for (int i = 0; i < SAIN_PAIR_INPUTS; i++) network->pair_low[i] = -FLT_MAX, network->pair_high[i] = FLT_MAX;
    for (int i = 0; i < SAIN_BODY_INPUTS; i++) network->body_low[i] = -FLT_MAX, network->body_high[i] = FLT_MAX;
    for (int o = 0; o < SAIN_OUTPUTS; o++) network->limit[o] = FLT_MAX;
}

/* size 0: all answers are 0. */
static inline void make_sain_network(SainNetwork *network, uint32_t *seed, float size) {
    Error error = {0};
    assert_ok(sain_network_create(network, &error), error);
    const int relation = network_parameter_count(network->relation), object = network_parameter_count(network->object);
    for (int i = 0; i < relation; i++) network->relation->weights[0][i] = uniform(seed, -size, size);
    for (int i = 0; i < object; i++) network->object->weights[0][i] = uniform(seed, -size, size);
    let_know_everything(network);
}
