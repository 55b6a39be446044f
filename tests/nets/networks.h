/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Networks for tests. */
#pragma once
#include "made.h"

/* Numbers in [-1, 1) from a linear congruential sequence. */
static inline double next_number(uint32_t *sequence) {
    *sequence = *sequence * 1664525u + 1013904223u;
    return *sequence / 2147483648.0 - 1;
}

static inline Network *make_network(int layers, const int *widths, const Activation *activations) {
    Network *network = network_sized(layers, widths);
    for (int l = 0; l < layers; l++) network->activations[l] = activations[l];
    uint32_t sequence = 1;
    for (int p = 0; p < network_parameter_count(network); p++) network->weights[0][p] = (float)next_number(&sequence);
    return network;
}
