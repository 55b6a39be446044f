/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The code of row_kernels.h; included once by each row_kernels_*.c, which says VECTOR_BYTES. */
#include "network/activation.h"
#include "network/row_kernels.h"

#include <string.h>

typedef float Floats __attribute__((vector_size(VECTOR_BYTES), aligned(sizeof(float)), may_alias));
typedef float Four __attribute__((vector_size(16), aligned(sizeof(float)), may_alias));

enum {
    FLOATS = VECTOR_BYTES / sizeof(float),
    LANE_VECTORS = ROW_LANES / FLOATS,            /* registers for the lanes of one row */
    CHAINS = 4,                                   /* sums of each column */
    GROUP = VECTOR_BYTES == 64 ? 4 : LANE_VECTORS /* columns at once: so many registers times CHAINS there are */
};

static inline const float *row_of(const float *rows, int width, const int32_t *index, int i) {
    return rows + (int64_t)(index != NULL ? index[i] : i) * width;
}

/* The columns from `at` on, as many as `vectors` registers hold, in CHAINS sums each: an addition waits for the one
   before it, and one chain of them would leave the processor idle. */
static inline __attribute__((always_inline)) void add_columns(float *sums, int width, const float *rows,
                                                              const int32_t *index, const float *numbers, int count,
                                                              int at, const int vectors) {
    Floats held[CHAINS][GROUP];
    for (int v = 0; v < vectors; v++) {
        held[0][v] = ((const Floats *)(sums + at))[v];
        for (int c = 1; c < CHAINS; c++) held[c][v] = (Floats){0};
    }
    int i = 0;
    for (; i + CHAINS <= count; i += CHAINS)
        for (int c = 0; c < CHAINS; c++) {
            const float *row = row_of(rows, width, index, i + c) + at;
            for (int v = 0; v < vectors; v++) held[c][v] += numbers[i + c] * ((const Floats *)row)[v];
        }
    for (int c = 0; i < count; i++, c++) {
        const float *row = row_of(rows, width, index, i) + at;
        for (int v = 0; v < vectors; v++) held[c][v] += numbers[i] * ((const Floats *)row)[v];
    }
    for (int v = 0; v < vectors; v++)
        ((Floats *)(sums + at))[v] = (held[0][v] + held[1][v]) + (held[2][v] + held[3][v]);
}

static void add(float *sums, int width, const float *rows, const int32_t *index, const float *numbers, int count) {
    int at = 0;
    for (; at + GROUP * FLOATS <= width; at += GROUP * FLOATS)
        add_columns(sums, width, rows, index, numbers, count, at, GROUP);
    for (; at < width; at += ROW_LANES) add_columns(sums, width, rows, index, numbers, count, at, LANE_VECTORS);
}

/* Lanes l, l + 4, l + 8, l + 12. */
static inline Four fold(const Floats sums[LANE_VECTORS]) {
    Four quarters[4];
    memcpy(quarters, sums, sizeof quarters);
    return (quarters[0] + quarters[2]) + (quarters[1] + quarters[3]);
}

static void multiply(float *products, int width, const float *rows, const int32_t *index, const float *vector,
                     int count) {
    for (int i = 0; i < count; i++) {
        const float *row = row_of(rows, 2 * width, index, i);
        Floats first[LANE_VECTORS], second[LANE_VECTORS];
        for (int v = 0; v < LANE_VECTORS; v++) first[v] = second[v] = (Floats){0};
        for (int at = 0; at < width; at += ROW_LANES)
            for (int v = 0; v < LANE_VECTORS; v++) {
                const Floats x = ((const Floats *)(vector + at))[v];
                first[v] += ((const Floats *)(row + at))[v] * x;
                second[v] += ((const Floats *)(row + width + at))[v] * x;
            }
        const Four a = fold(first), b = fold(second);
        const Four sums = __builtin_shufflevector(a, b, 0, 4, 1, 5) + __builtin_shufflevector(a, b, 2, 6, 3, 7);
        products[2 * i] = sums[0] + sums[2];
        products[2 * i + 1] = sums[1] + sums[3];
    }
}

static void spread(float *rows, int width, const int32_t *index, const float *numbers, const float *vector, int count) {
    for (int i = 0; i < count; i++) {
        float *row = rows + (int64_t)(index != NULL ? index[i] : i) * width;
        for (int at = 0; at < width; at += FLOATS) *(Floats *)(row + at) += numbers[i] * *(const Floats *)(vector + at);
    }
}

static void bend(float *numbers, int count) {
    for (int i = 0; i < count; i++) numbers[i] = tanh_float(numbers[i]);
}

const RowKernels ROW_KERNELS = {ROW_KERNELS_NAME, add, multiply, spread, bend};
