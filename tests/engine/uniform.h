/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include "testing.h"

/* A number of [low, high), the same sequence everywhere (constants of Numerical Recipes). */
static inline float uniform(uint32_t *seed, float low, float high) {
    *seed = *seed * 1664525u + 1013904223u;
    return low + (high - low) * (float)(*seed >> 8) / 16777216.0f;
}
