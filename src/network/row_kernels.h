/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of a network with sparse inputs (slot_network.h). A matrix has one row per possible input, and only the
   rows of inputs that are present are read. Memory traffic dominates, so rows are packed into bytes. Compiled once for
   each instruction set from row_kernels_code.h, with the same operations in the same order, so all have the same
   bits. */
#pragma once
#include "network/packed_rows.h"

enum { ROW_LANES = 16 }; /* the width of a row is a multiple of this */

typedef struct RowKernels {
    const char *name;
    /* sums[width] += (numbers[i] * unit) * row index[i] for each i < count; index NULL: row i. In four partial sums,
       one for each i modulo 4 in rising order, the first starting from sums; then (0 + 1) + (2 + 3). */
    void (*add)(float *sums, const PackedRows *rows, const int32_t *index, const float *numbers, int count);
    /* sums[width] += numbers[i] * row i of rows[count, width], in float, in the order of `add`. */
    void (*combine)(float *sums, const float *rows, int width, const float *numbers, int count);
    /* products[2 i], [2 i + 1]: the dot products of rows 2 index[i] and 2 index[i] + 1 with vector[width], each in
       ROW_LANES partial sums that are added in halves, times the row's unit. */
    void (*multiply)(float *products, const PackedRows *rows, const int32_t *index, const float *vector, int count);
    /* rows[index[i]] += numbers[i] * vector[width] */
    void (*spread)(float *rows, int width, const int32_t *index, const float *numbers, const float *vector, int count);
    /* numbers[i] = tanh(numbers[i]), as in activation.h */
    void (*apply_tanh)(float *numbers, int count);
} RowKernels;

extern const RowKernels row_kernels_scalar, row_kernels_avx2, row_kernels_avx512;

/* The kernels that this CPU supports, widest first; ends with NULL. */
enum { ROW_KERNELS_MAX = 3 };
void row_kernels_list(const RowKernels *list[ROW_KERNELS_MAX + 1]);

/* The first of the list. */
const RowKernels *row_kernels_best(void);
