/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/png_filter.h"

#include <stdlib.h>
#include <string.h>

enum { NONE, SUB, UP, AVERAGE, PAETH };

static void add_up(const uint8_t *restrict from, const uint8_t *restrict above, size_t bytes, uint8_t *restrict row) {
    for (size_t i = 0; i < bytes; i++) row[i] = (uint8_t)(from[i] + above[i]);
}

/* The functions below are compiled once for each step, as a constant. */
static inline void add_left(const uint8_t *restrict from, size_t bytes, size_t step, uint8_t *restrict row) {
    uint8_t left[4] = {0};
    for (size_t i = 0; i + step <= bytes; i += step)
        for (size_t c = 0; c < step; c++) row[i + c] = left[c] = (uint8_t)(from[i + c] + left[c]);
}

typedef uint8_t Bytes __attribute__((vector_size(16)));
typedef uint32_t Pixels __attribute__((vector_size(16)));

/* Four pixels of four bytes at once: sums of neighbours, then of pairs, then with all before. */
static void add_left_rgba(const uint8_t *restrict from, size_t bytes, uint8_t *restrict row) {
    static const Pixels not_first = {0, UINT32_MAX, UINT32_MAX, UINT32_MAX}, last_two = {0, 0, UINT32_MAX, UINT32_MAX};
    Pixels before = {0};
    size_t i = 0;
    for (; i + sizeof before <= bytes; i += sizeof before) {
        Pixels pixels;
        memcpy(&pixels, from + i, sizeof pixels);
        pixels = (Pixels)((Bytes)pixels + (Bytes)(__builtin_shufflevector(pixels, pixels, 0, 0, 1, 2) & not_first));
        pixels = (Pixels)((Bytes)pixels + (Bytes)(__builtin_shufflevector(pixels, pixels, 0, 0, 0, 1) & last_two));
        pixels = (Pixels)((Bytes)pixels + (Bytes)before);
        memcpy(row + i, &pixels, sizeof pixels);
        before = __builtin_shufflevector(pixels, pixels, 3, 3, 3, 3);
    }
    for (; i < bytes; i++) row[i] = (uint8_t)(from[i] + (i < 4 ? 0 : row[i - 4]));
}

static inline void add_average(const uint8_t *restrict from, const uint8_t *restrict above, size_t bytes, size_t step,
                               uint8_t *restrict row) {
    uint8_t left[4] = {0};
    for (size_t i = 0; i + step <= bytes; i += step)
        for (size_t c = 0; c < step; c++) row[i + c] = left[c] = (uint8_t)(from[i + c] + (left[c] + above[i + c]) / 2);
}

/* The neighbour nearest to left + up - corner; the first of these where they tie. */
static inline int predict(int left, int up, int corner) {
    int to_left = abs(up - corner), to_up = abs(left - corner), to_corner = abs(left + up - 2 * corner);
    int nearest = to_up <= to_corner ? up : corner, distance = to_up <= to_corner ? to_up : to_corner;
    return to_left <= distance ? left : nearest;
}

static inline void add_paeth(const uint8_t *restrict from, const uint8_t *restrict above, size_t bytes, size_t step,
                             uint8_t *restrict row) {
    int left[4] = {0}, corner[4] = {0};
    for (size_t i = 0; i + step <= bytes; i += step)
        for (size_t c = 0; c < step; c++) {
            int up = above[i + c];
            row[i + c] = (uint8_t)(from[i + c] + predict(left[c], up, corner[c]));
            left[c] = row[i + c], corner[c] = up;
        }
}

/* Filters that refer to the left. */
static inline bool unfilter_step(int filter, const uint8_t *from, const uint8_t *above, size_t bytes, size_t step,
                                 uint8_t *row) {
    if (filter == SUB)
        add_left(from, bytes, step, row);
    else if (filter == AVERAGE)
        add_average(from, above, bytes, step, row);
    else if (filter == PAETH)
        add_paeth(from, above, bytes, step, row);
    else
        return false;
    return true;
}

bool png_unfilter(const uint8_t *filtered, const uint8_t *above, size_t bytes, int step, uint8_t *row) {
    int filter = filtered[0];
    const uint8_t *from = filtered + 1;
    if (filter == NONE)
        memcpy(row, from, bytes);
    else if (filter == UP)
        add_up(from, above, bytes, row);
    else if (filter == SUB && step == 4)
        add_left_rgba(from, bytes, row);
    else
        return step == 4   ? unfilter_step(filter, from, above, bytes, 4, row)
               : step == 3 ? unfilter_step(filter, from, above, bytes, 3, row)
               : step == 2 ? unfilter_step(filter, from, above, bytes, 2, row)
                           : unfilter_step(filter, from, above, bytes, 1, row);
    return true;
}
