/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Of two numbers, the smaller, the larger or their divisor; round numbers for axes and scale bars. */
#pragma once
#include <math.h>
#include <stddef.h>
#include <stdint.h>

static inline int int_min(int a, int b) { return a < b ? a : b; }
static inline int int_max(int a, int b) { return a > b ? a : b; }
static inline size_t size_min(size_t a, size_t b) { return a < b ? a : b; }
static inline size_t size_max(size_t a, size_t b) { return a > b ? a : b; }

/* The greatest common divisor of two numbers that are not negative and not both 0. */
static inline int64_t greatest_divisor(int64_t a, int64_t b) {
    while (b != 0) {
        const int64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

/* The largest 1, 2 or 5 times a power of ten that is at most `most`; most > 0. */
static inline double round_down(double most) {
    const double power = pow(10, floor(log10(most))), share = most / power;
    return power * (share >= 5 ? 5 : share >= 2 ? 2 : 1);
}

/* The smallest that is at least `least`; least > 0. */
static inline double round_up(double least) {
    const double exponent = floor(log10(least)), power = pow(10, exponent), share = least / power;
    return share > 5 ? pow(10, exponent + 1) : power * (share > 2 ? 5 : share > 1 ? 2 : 1);
}
