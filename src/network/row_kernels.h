/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of a network that meets few of many possible numbers at a time (slot_network.h). A matrix is kept as rows,
   one for each number that there may be, and only the rows of those that there are get touched; what that costs is
   mostly fetching them, so they are packed into bytes. Compiled once for each instruction set from row_kernels_code.h,
   with the same operations in the same order, so all give the same bits. */
#pragma once
#include "network/packed_rows.h"

enum { ROW_LANES = 16 }; /* the width of a row is a multiple of this */

typedef struct RowKernels {
    const char *name;
    /* sums[width] += (numbers[i] * unit) * row index[i] for each i < count; index NULL: row i. In four sums, one for each
       i modulo 4 in rising order, the first from what was there; then (0 + 1) + (2 + 3). */
    void (*add)(float *sums, const PackedRows *rows, const int32_t *index, const float *numbers, int count);
    /* products[2 i], [2 i + 1]: the products of rows 2 index[i] and the one after it with vector[width], each as
       ROW_LANES sums that are added in halves, times the row's unit. */
    void (*multiply)(float *products, const PackedRows *rows, const int32_t *index, const float *vector, int count);
    /* rows[index[i]] += numbers[i] * vector[width] */
    void (*spread)(float *rows, int width, const int32_t *index, const float *numbers, const float *vector, int count);
    /* numbers[i] = tanh(numbers[i]) as activation.h has it */
    void (*bend)(float *numbers, int count);
} RowKernels;

extern const RowKernels row_kernels_plain, row_kernels_avx2, row_kernels_avx512;

/* Those that this CPU can run, widest first; ends with NULL. */
enum { ROW_KERNELS_MAX = 3 };
void row_kernels_list(const RowKernels *list[ROW_KERNELS_MAX + 1]);

/* The first of the list. */
const RowKernels *row_kernels_best(void);
