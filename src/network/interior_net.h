/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The network of interior-net (solvers/interior.c). In each of the first iterations it sees each contact by itself and
   chooses how far this iteration moves it towards its bounds. One set of weights serves all contacts and all scenes; the
   biases differ between iterations.

       h = leaky(W x + b_i),   y = 2^clamp(V h + c_i),   leaky(x) = max(x, x / 8)

   For a contact with normal impulse l, gap velocity z, effective mass m, normal velocity beyond its target g and the
   target l z = tau^2 m, the inputs are log2(l / (m tau)) / 4, log2(z / tau) / 4 and g / z - 1, at most 2 either way;
   the outputs are factors of l (and t), of z and of the target. Logarithms and powers are straight lines between powers
   of two, taken from the bits of the number: a few operations, and the same bits everywhere. */
#pragma once
#include "common/error.h"

#include <stdint.h>
#include <string.h>

enum {
    INTERIOR_NET_VERSION = 1,
    INTERIOR_NET_INPUTS = 3,
    INTERIOR_NET_HIDDEN = 4,
    INTERIOR_NET_OUTPUTS = 3,
    INTERIOR_NET_STEPS = 6, /* iterations with the network */
    /* offsets in the weights */
    INTERIOR_NET_HIDDEN_WEIGHTS = 0, /* [hidden, inputs] */
    INTERIOR_NET_OUTPUT_WEIGHTS = INTERIOR_NET_HIDDEN * INTERIOR_NET_INPUTS, /* [outputs, hidden] */
    INTERIOR_NET_HIDDEN_BIASES =
        INTERIOR_NET_OUTPUT_WEIGHTS + INTERIOR_NET_OUTPUTS * INTERIOR_NET_HIDDEN, /* [steps, hidden] */
    INTERIOR_NET_OUTPUT_BIASES =
        INTERIOR_NET_HIDDEN_BIASES + INTERIOR_NET_STEPS * INTERIOR_NET_HIDDEN, /* [steps, outputs] */
    INTERIOR_NET_WEIGHTS = INTERIOR_NET_OUTPUT_BIASES + INTERIOR_NET_STEPS * INTERIOR_NET_OUTPUTS
};

#define INTERIOR_NET_LIMIT 4.0 /* of clamp(): factors of 1/16 to 16 */
#define INTERIOR_NET_GAP 2.0   /* of the third input */
#define INTERIOR_NET_LEAK 0.125

typedef struct InteriorNet {
    double weights[INTERIOR_NET_WEIGHTS]; /* all of them float32 numbers */
    char command[1024];                   /* that trained it */
} InteriorNet;

/* log2 x for a normal x > 0, and its inverse for -1000 <= x <= 1000. */
static inline double interior_net_log2(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return (double)(int64_t)(bits >> 12) * 0x1p-40 - 1023;
}

static inline double interior_net_power2(double x) {
    const double whole = (x + 1023) * 0x1p40 + 0x1p52; /* the whole part of the product in the lower bits */
    uint64_t bits;
    double power;
    memcpy(&bits, &whole, sizeof bits);
    bits <<= 12;
    memcpy(&power, &bits, sizeof power);
    return power;
}

bool interior_net_write(const InteriorNet *net, const char *path, Error *error);

/* False with error set: not such a file, or a number that is NaN or infinite. */
bool interior_net_read(InteriorNet *net, const char *path, Error *error);
