/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The network of interior-net (solvers/interior.c). While the residual is large, it sees each contact by itself before an
   iteration and moves it within its bounds. One set of weights serves all contacts, iterations and scenes.

       h = leaky(W x + B g),   y = 2^clamp(V h + C g),   leaky(x) = max(x, x / 8)

   For a contact with normal impulse l, gap velocity z, effective mass m, normal velocity u beyond its target and the
   aim l z = tau^2 m, the inputs x are log2(l / (m tau)) / 4, log2(z / tau) / 4 and u / z - 1; the outputs y are factors
   of l (and t), of z and of the aim. g is the same for all contacts, so it costs nothing: 1, whether it is the first
   iteration, log2(tau / tau of the first) / 8 and log2(residual / tau) / 4. Logarithms and powers are straight lines
   between powers of two, taken from the bits of the number: a few operations, and the same bits everywhere. */
#pragma once
#include "common/error.h"

#include <stdint.h>
#include <string.h>

enum {
    INTERIOR_NET_VERSION = 1,
    INTERIOR_NET_INPUTS = 3,
    INTERIOR_NET_HIDDEN = 4,
    INTERIOR_NET_OUTPUTS = 3,
    INTERIOR_NET_GLOBALS = 4,
    /* offsets in the weights */
    INTERIOR_NET_HIDDEN_WEIGHTS = 0,                                         /* W [hidden, inputs] */
    INTERIOR_NET_OUTPUT_WEIGHTS = INTERIOR_NET_HIDDEN * INTERIOR_NET_INPUTS, /* V [outputs, hidden] */
    INTERIOR_NET_HIDDEN_BIASES =
        INTERIOR_NET_OUTPUT_WEIGHTS + INTERIOR_NET_OUTPUTS * INTERIOR_NET_HIDDEN, /* B [globals, hidden] */
    INTERIOR_NET_OUTPUT_BIASES =
        INTERIOR_NET_HIDDEN_BIASES + INTERIOR_NET_GLOBALS * INTERIOR_NET_HIDDEN, /* C [globals, outputs] */
    INTERIOR_NET_WEIGHTS = INTERIOR_NET_OUTPUT_BIASES + INTERIOR_NET_GLOBALS * INTERIOR_NET_OUTPUTS
};

#define INTERIOR_NET_UNTIL 0.05 /* m/s: iterations do without the network once the residual is at most this */
#define INTERIOR_NET_LIMIT 4.0  /* of clamp(): factors of 1/16 to 16 */
#define INTERIOR_NET_INPUT 2.0  /* limit of the third input and of the last two of g */
#define INTERIOR_NET_LEAK 0.125
#define INTERIOR_NET_SMALL 1e-9 /* m/s, added to the residual: its logarithm must exist */

typedef struct InteriorNet {
    double weights[INTERIOR_NET_WEIGHTS]; /* float32 numbers; all zero: iterations as without a network */
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
