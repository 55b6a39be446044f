/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loops of networks, compiled once for each instruction set (CMakeLists.txt) from kernels_code.h. All perform the
   same operations in the same order, so they have the same bits; the widest that the CPU supports is used. */
#pragma once
#include "nets/nets.h"

#include <stdbool.h>

/* A quantised matrix, a quarter of the size of floats: each number is a byte, times a unit per row. Rounding to 127
   steps of the row's largest number changes a network's outputs by less than 1%, and training compensates for it
   (learning/scene_net_fit.h). */

typedef struct PackedRows {
    int count, width;
    int8_t *numbers; /* [count, width] -127 .. 127 */
    float *units;    /* [count] */
} PackedRows;

/* In a block of packed_rows_bytes() that is aligned for floats and begins with the units; the block may be NULL. */
PackedRows packed_rows_in(void *block, int count, int width);
size_t packed_rows_bytes(int count, int width);

/* Rounds rows[count, width] of finite numbers to the nearest steps. */
void packed_rows_fill(PackedRows *packed, const float *rows);

/* The loops of a network with sparse inputs (SceneNet). A matrix has one row per possible input, and only the
   rows of inputs that are present are read. Memory traffic dominates, so rows are packed into bytes. */

enum { ROW_LANES = 16 }; /* the width of a row is a multiple of this */

typedef struct RowKernels {
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
    /* numbers[i] = tanh(numbers[i]), as tanh_float() */
    void (*apply_tanh)(float *numbers, int count);
} RowKernels;

/* The loops over particles and edges. Rows are items, features are innermost. */

typedef struct GnsKernels {
    /* out[rows, outputs] = biases[outputs] + in[rows, inputs] weights[inputs, outputs]; biases NULL: adds to out. */
    void (*multiply)(float *out, const float *in, const float *weights, const float *biases, int rows, int inputs,
                     int outputs);
    /* gradient[inputs, outputs] += in^T slopes, over in[rows, inputs] and slopes[rows, outputs]. */
    void (*add_gradient)(float *gradient, const float *in, const float *slopes, int rows, int inputs, int outputs);
    /* out[rows, width] += of[at[row], width] */
    void (*add_rows)(float *out, const float *of, const int *at, int rows, int width);
    /* out[at[row], width] += of[rows, width] */
    void (*add_to_rows)(float *out, const float *of, const int *at, int rows, int width);
    void (*relu)(float *values, int count);
    /* Layer norm (Ba, Kiros, Hinton 2016) of values[rows, width], which become the normalised ones; inverse[rows] is
       1 / deviation; out = normalised * gain + offset. */
    void (*normalise)(float *values, float *inverse, float *out, const float *gain, const float *offset, int rows,
                      int width);
    /* From d loss / d out to d loss / d values, before the norm: slopes[rows, width] in place. */
    void (*normalise_back)(float *slopes, const float *normalised, const float *inverse, const float *gain, int rows,
                           int width);
} GnsKernels;

/* Rows of a batch that pass the layers together: 2 x 10 x 64 numbers stay in the L1 cache. */
enum { TILE_ROWS = 64, CACHE_LINE = 64 };

typedef struct Kernels {
    const char *name;
    /* Rows first to first + count - 1, at most TILE_ROWS, of a batch: network_predict_batch(). */
    void (*predict)(const Network *network, const float *inputs, float *scratch, float *outputs, int rows, int first,
                    int count);
    /* As the functions of a NetworkBlock. */
    void (*forward)(NetworkBlock *block, const double *parameters);
    void (*backward)(NetworkBlock *block, const double *parameters);
    void (*backward_to_inputs)(const NetworkBlock *block, const double *parameters, double *slopes);
    void (*add_gradient)(const NetworkBlock *block, double *gradient);
    double (*dot)(const double *a, const double *b);
    RowKernels rows;
    GnsKernels gns;
} Kernels;

extern const Kernels kernels_scalar, kernels_avx2, kernels_avx512;

/* The kernels that this CPU supports, widest first; ends with NULL. */
enum { KERNELS_MAX = 3 };
void kernels_list(const Kernels *list[KERNELS_MAX + 1]);

/* The first of the list. */
const Kernels *kernels_best(void);
