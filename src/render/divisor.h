/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frame rates in lowest terms. */
#pragma once
#include <stdint.h>

/* Of two numbers that are not negative and not both 0. */
static inline int64_t greatest_divisor(int64_t a, int64_t b) {
    while (b != 0) {
        const int64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}
