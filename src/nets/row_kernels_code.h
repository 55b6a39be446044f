/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "nets/kernels.h"
#include "nets/nets.h"

#include <string.h>

/* The code of RowKernels (kernels.h); included by kernels_code.h. */
#if VECTOR_BYTES > 16
#include <immintrin.h>
#endif

typedef float Four __attribute__((vector_size(16), aligned(sizeof(float)), may_alias));

enum {
    LANE_VECTORS = ROW_LANES / FLOATS,                /* registers for the lanes of one row */
    CHAINS = 4,                                       /* sums of each column */
    ROW_GROUP = VECTOR_BYTES == 64 ? 4 : LANE_VECTORS /* columns at once, in CHAINS times as many registers */
};

/* Converts to floats; gcc 12 splits a vector conversion into single bytes. */
static inline Floats load(const int8_t *bytes) {
#if VECTOR_BYTES == 64
    return (Floats)_mm512_cvtepi32_ps(_mm512_cvtepi8_epi32(_mm_loadu_si128((const __m128i *)bytes)));
#elif VECTOR_BYTES == 32
    return (Floats)_mm256_cvtepi32_ps(_mm256_cvtepi8_epi32(_mm_loadl_epi64((const __m128i *)bytes)));
#else
    return (Floats){bytes[0], bytes[1], bytes[2], bytes[3]};
#endif
}

static inline int64_t row_at(const int32_t *index, int i) { return index != NULL ? index[i] : i; }

static inline __attribute__((always_inline)) void add_row(Floats held[ROW_GROUP], const PackedRows *rows, int64_t row,
                                                          float number, int at, const int vectors) {
    const int8_t *from = rows->numbers + row * rows->width + at;
    const float by = number * rows->units[row];
    for (int v = 0; v < vectors; v++) held[v] += by * load(from + v * FLOATS);
}

/* The columns from `at` on, as many as `vectors` registers hold, in CHAINS partial sums each, to hide the latency of
   additions. */
static inline __attribute__((always_inline)) void add_columns(float *sums, const PackedRows *rows, const int32_t *index,
                                                              const float *numbers, int count, int at,
                                                              const int vectors) {
    Floats held[CHAINS][ROW_GROUP];
    for (int v = 0; v < vectors; v++) {
        held[0][v] = ((const Floats *)(sums + at))[v];
        for (int c = 1; c < CHAINS; c++) held[c][v] = (Floats){0};
    }
    int i = 0;
    for (; i + CHAINS <= count; i += CHAINS)
        for (int c = 0; c < CHAINS; c++) add_row(held[c], rows, row_at(index, i + c), numbers[i + c], at, vectors);
    for (int c = 0; c < CHAINS - 1; c++)
        if (i + c < count) add_row(held[c], rows, row_at(index, i + c), numbers[i + c], at, vectors);
    for (int v = 0; v < vectors; v++)
        ((Floats *)(sums + at))[v] = (held[0][v] + held[1][v]) + (held[2][v] + held[3][v]);
}

static void add(float *sums, const PackedRows *rows, const int32_t *index, const float *numbers, int count) {
    int at = 0;
    for (; at + ROW_GROUP * FLOATS <= rows->width; at += ROW_GROUP * FLOATS)
        add_columns(sums, rows, index, numbers, count, at, ROW_GROUP);
    for (; 2 * LANE_VECTORS < ROW_GROUP && at + 2 * ROW_LANES <= rows->width; at += 2 * ROW_LANES)
        add_columns(sums, rows, index, numbers, count, at, 2 * LANE_VECTORS);
    for (; at < rows->width; at += ROW_LANES) add_columns(sums, rows, index, numbers, count, at, LANE_VECTORS);
}

static void combine(float *sums, const float *rows, int width, const float *numbers, int count) {
    for (int at = 0; at < width; at += ROW_LANES) {
        Floats held[CHAINS][LANE_VECTORS] = {{{0}}};
        memcpy(held[0], sums + at, sizeof held[0]);
        int i = 0;
        for (; i + CHAINS <= count; i += CHAINS)
            for (int c = 0; c < CHAINS; c++)
                for (int v = 0; v < LANE_VECTORS; v++)
                    held[c][v] += numbers[i + c] * ((const Floats *)(rows + (int64_t)(i + c) * width + at))[v];
        for (int c = 0; i + c < count; c++)
            for (int v = 0; v < LANE_VECTORS; v++)
                held[c][v] += numbers[i + c] * ((const Floats *)(rows + (int64_t)(i + c) * width + at))[v];
        for (int v = 0; v < LANE_VECTORS; v++)
            ((Floats *)(sums + at))[v] = (held[0][v] + held[1][v]) + (held[2][v] + held[3][v]);
    }
}

/* Lanes l, l + 4, l + 8, l + 12. */
static inline Four fold(const Floats sums[LANE_VECTORS]) {
    Four quarters[4];
    memcpy(quarters, sums, sizeof quarters);
    return (quarters[0] + quarters[2]) + (quarters[1] + quarters[3]);
}

static void row_multiply(float *products, const PackedRows *rows, const int32_t *index, const float *vector,
                         int count) {
    const int width = rows->width;
    for (int i = 0; i < count; i++) {
        const int64_t pair = 2 * row_at(index, i);
        const int8_t *row = rows->numbers + pair * width;
        Floats first[LANE_VECTORS], second[LANE_VECTORS];
        for (int v = 0; v < LANE_VECTORS; v++) first[v] = second[v] = (Floats){0};
        for (int at = 0; at < width; at += ROW_LANES)
            for (int v = 0; v < LANE_VECTORS; v++) {
                const int lane = at + v * FLOATS;
                const Floats x = *(const Floats *)(vector + lane);
                first[v] += load(row + lane) * x;
                second[v] += load(row + width + lane) * x;
            }
        const Four a = fold(first), b = fold(second);
        const Four sums = __builtin_shufflevector(a, b, 0, 4, 1, 5) + __builtin_shufflevector(a, b, 2, 6, 3, 7);
        products[2 * i] = rows->units[pair] * (sums[0] + sums[2]);
        products[2 * i + 1] = rows->units[pair + 1] * (sums[1] + sums[3]);
    }
}

static void spread(float *rows, int width, const int32_t *index, const float *numbers, const float *vector, int count) {
    for (int i = 0; i < count; i++) {
        float *row = rows + row_at(index, i) * width;
        for (int at = 0; at < width; at += FLOATS) *(Floats *)(row + at) += numbers[i] * *(const Floats *)(vector + at);
    }
}

static void apply_tanh(float *numbers, int count) {
    for (int i = 0; i < count; i++) numbers[i] = tanh_float(numbers[i]);
}
