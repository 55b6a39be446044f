/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random numbers, the same on every machine: SplitMix64 (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number
   Generators", 2014).

     uint64_t state = seed;
     const double share = random_unit(&state); */
#pragma once
#include <math.h>
#include <stdint.h>

static inline uint64_t split_mix(uint64_t *state) {
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

/* In [0, 1), in [-1, 1), and below a count. */
static inline double random_unit(uint64_t *state) { return (double)(split_mix(state) >> 11) * 0x1p-53; }
static inline double random_signed(uint64_t *state) { return (double)(split_mix(state) >> 11) * 0x1p-52 - 1; }
static inline int random_below(uint64_t *state, int count) { return (int)(split_mix(state) % (uint64_t)count); }

/* The first weights of a layer, uniform with the variance size^2 / inputs, so that a layer keeps the size of its
   numbers (LeCun, Bottou, Orr, Mueller, "Efficient BackProp", 1998), then its biases, 0. Returns what follows them. */
static inline double *weights_of_layer(double *weights, int inputs, int units, double size, uint64_t *state) {
    const double bound = size * sqrt(3.0 / inputs);
    for (int i = 0; i < inputs * units; i++) *weights++ = bound * random_signed(state);
    for (int i = 0; i < units; i++) *weights++ = 0;
    return weights;
}
