/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Selection by radix: bits of floats from 0 sort as the floats do. Linear in time, whatever the values. */
#include "image/largest.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

bool largest_create(Largest *largest, size_t keep, Error *error) {
    *largest = (Largest){.keep = keep};
    largest->values = malloc(2 * keep * sizeof *largest->values);
    return largest->values != NULL || error_memory(error, "percentile");
}

void largest_free(Largest *largest) { free(largest->values); }

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* The value that `rank` - 1 values exceed or equal; rank is at most count. */
static float select(const float *values, size_t count, size_t rank) {
    enum { DIGIT = 11, DIGITS = 1 << DIGIT };
    uint32_t prefix = 0, known = 0; /* bits of the result, and a mask of those known */
    for (int shift = 32 - DIGIT; known != UINT32_MAX; shift = shift > DIGIT ? shift - DIGIT : 0) {
        size_t counts[DIGITS] = {0};
        for (size_t i = 0; i < count; i++) {
            uint32_t bits = bits_of(values[i]);
            if ((bits & known) == prefix) counts[bits >> shift & (DIGITS - 1)]++;
        }
        uint32_t digit = DIGITS - 1;
        for (; counts[digit] < rank; digit--) rank -= counts[digit];
        prefix |= digit << shift;
        known |= (uint32_t)(DIGITS - 1) << shift;
    }
    float value;
    memcpy(&value, &prefix, sizeof value);
    return value;
}

/* Keeps the largest values. Of those equal to the least, all but enough are dropped. */
static void shrink(Largest *largest) {
    float least = select(largest->values, largest->count, largest->keep);
    size_t count = 0;
    for (size_t i = 0; i < largest->count; i++)
        if (largest->values[i] > least) largest->values[count++] = largest->values[i];
    while (count < largest->keep) largest->values[count++] = least;
    largest->count = count;
    largest->least = least;
}

void largest_add(Largest *largest, float value) {
    if (value <= largest->least) return;
    largest->values[largest->count++] = value;
    if (largest->count == 2 * largest->keep) shrink(largest);
}

float largest_least(Largest *largest) {
    if (largest->count < largest->keep) return 0;
    shrink(largest);
    return largest->least;
}
