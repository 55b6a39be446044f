/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The code of GnsKernels (kernels.h); included by kernels_code.h. Every sum runs over its items in rising order. */
#include "nets/kernels.h"

/* ROWS_AT_ONCE: as many rows as have the sums of COLUMNS columns in eight registers, of FLOATS (kernels_code.h). */
enum { WIDE = 8, COLUMNS = 2 * WIDE, VECTORS = COLUMNS / FLOATS, ROWS_AT_ONCE = 8 / VECTORS };

/* Two registers where one holds four floats. */
typedef float Lanes __attribute__((vector_size(WIDE * sizeof(float)), aligned(sizeof(float)), may_alias));

/* The variance of a row of equal numbers is 0. */
static const float least_variance = 1e-5f;

/* What sums begin with: start[row * step + column]. */
typedef struct Start {
    const float *start;
    ptrdiff_t step;
} Start;

/* out[rows, columns] = start + a b[depth, columns], a[row, d] at a[row * row_step + d * depth_step], for COLUMNS
   columns and `rows` rows, a constant after inlining. */
static inline __attribute__((always_inline)) void multiply_block(float *out, int columns, Start from, const float *a,
                                                                 ptrdiff_t row_step, ptrdiff_t depth_step,
                                                                 const float *b, int depth, const int rows) {
    Floats sums[ROWS_AT_ONCE][VECTORS];
    for (int r = 0; r < rows; r++)
        for (int v = 0; v < VECTORS; v++) sums[r][v] = *(const Floats *)(from.start + r * from.step + v * FLOATS);
    for (int d = 0; d < depth; d++) {
        for (int r = 0; r < rows; r++) {
            const float x = a[r * row_step + d * depth_step];
            for (int v = 0; v < VECTORS; v++) sums[r][v] += x * *(const Floats *)(b + v * FLOATS);
        }
        b += columns;
    }
    for (int r = 0; r < rows; r++)
        for (int v = 0; v < VECTORS; v++) *(Floats *)(out + (ptrdiff_t)r * columns + v * FLOATS) = sums[r][v];
}

static void multiply(float *out, int rows, int columns, Start from, const float *a, ptrdiff_t row_step,
                     ptrdiff_t depth_step, const float *b, int depth) {
    int row = 0, column;
    for (; row + ROWS_AT_ONCE <= rows; row += ROWS_AT_ONCE)
        for (column = 0; column + COLUMNS <= columns; column += COLUMNS)
            multiply_block(out + (ptrdiff_t)row * columns + column, columns,
                           (Start){from.start + row * from.step + column, from.step}, a + row * row_step, row_step,
                           depth_step, b + column, depth, ROWS_AT_ONCE);
    for (; row < rows; row++)
        for (column = 0; column + COLUMNS <= columns; column += COLUMNS)
            multiply_block(out + (ptrdiff_t)row * columns + column, columns,
                           (Start){from.start + row * from.step + column, 0}, a + row * row_step, row_step, depth_step,
                           b + column, depth, 1);
    for (row = 0; row < rows; row++)
        for (column = columns - columns % COLUMNS; column < columns; column++) {
            float sum = from.start[row * from.step + column];
            for (int d = 0; d < depth; d++)
                sum += a[row * row_step + d * depth_step] * b[(ptrdiff_t)d * columns + column];
            out[(ptrdiff_t)row * columns + column] = sum;
        }
}

static void gns_multiply(float *out, const float *in, const float *weights, const float *biases, int rows, int inputs,
                         int outputs) {
    multiply(out, rows, outputs, biases != NULL ? (Start){biases, 0} : (Start){out, outputs}, in, inputs, 1, weights,
             inputs);
}

static void gns_add_gradient(float *gradient, const float *in, const float *slopes, int rows, int inputs, int outputs) {
    multiply(gradient, inputs, outputs, (Start){gradient, outputs}, in, 1, inputs, slopes, rows);
}

static void add_rows(float *out, const float *of, const int *at, int rows, int width) {
    for (int r = 0; r < rows; r++) {
        float *to = out + (ptrdiff_t)r * width;
        const float *from = of + (ptrdiff_t)at[r] * width;
        for (int j = 0; j < width; j += WIDE) *(Lanes *)(to + j) += *(const Lanes *)(from + j);
    }
}

static void add_to_rows(float *out, const float *of, const int *at, int rows, int width) {
    for (int r = 0; r < rows; r++) {
        float *to = out + (ptrdiff_t)at[r] * width;
        const float *from = of + (ptrdiff_t)r * width;
        for (int j = 0; j < width; j += WIDE) *(Lanes *)(to + j) += *(const Lanes *)(from + j);
    }
}

static void gns_relu(float *values, int count) {
    for (int i = 0; i < count; i++) values[i] = values[i] < 0.0f ? 0.0f : values[i];
}

static inline float gns_total(const Lanes *parts) {
    const float *p = (const float *)parts;
    return ((p[0] + p[4]) + (p[2] + p[6])) + ((p[1] + p[5]) + (p[3] + p[7]));
}

/* Rows that share divisions and roots. */
enum { NORMS = 4 };
typedef float Norms __attribute__((vector_size(NORMS * sizeof(float))));

/* gns_total() of each. */
static inline Norms totals(const Lanes parts[NORMS]) {
    Norms halves[NORMS], pairs[NORMS / 2];
    for (int r = 0; r < NORMS; r++)
        halves[r] = __builtin_shufflevector(parts[r], parts[r], 0, 1, 2, 3) +
                    __builtin_shufflevector(parts[r], parts[r], 4, 5, 6, 7);
    for (int r = 0; r < NORMS / 2; r++)
        pairs[r] = __builtin_shufflevector(halves[2 * r], halves[2 * r + 1], 0, 1, 4, 5) +
                   __builtin_shufflevector(halves[2 * r], halves[2 * r + 1], 2, 3, 6, 7);
    return __builtin_shufflevector(pairs[0], pairs[1], 0, 2, 4, 6) +
           __builtin_shufflevector(pairs[0], pairs[1], 1, 3, 5, 7);
}

/* `rows`: up to NORMS, a constant after inlining. */
static inline __attribute__((always_inline)) void normalise_rows(float *values, float *inverse, float *out,
                                                                 const float *gain, const float *offset, const int rows,
                                                                 int width) {
    Lanes sums[NORMS] = {{0}}, squares[NORMS] = {{0}};
    for (int j = 0; j < width; j += WIDE)
        for (int r = 0; r < rows; r++) sums[r] += *(Lanes *)(values + r * width + j);
    const Norms means = totals(sums) / (float)width;
    for (int j = 0; j < width; j += WIDE)
        for (int r = 0; r < rows; r++) {
            Lanes *of = (Lanes *)(values + r * width + j);
            *of -= means[r];
            squares[r] += *of * *of;
        }
    Norms deviations = totals(squares) / (float)width + least_variance;
    for (int r = 0; r < NORMS; r++) deviations[r] = sqrtf(deviations[r]);
    const Norms factors = 1.0f / deviations;
    for (int r = 0; r < rows; r++) inverse[r] = factors[r];
    for (int j = 0; j < width; j += WIDE)
        for (int r = 0; r < rows; r++) {
            Lanes *of = (Lanes *)(values + r * width + j);
            *of *= factors[r];
            *(Lanes *)(out + r * width + j) = *of * *(const Lanes *)(gain + j) + *(const Lanes *)(offset + j);
        }
}

static void normalise(float *values, float *inverse, float *out, const float *gain, const float *offset, int rows,
                      int width) {
    int row = 0;
    for (; row + NORMS <= rows; row += NORMS)
        normalise_rows(values + (ptrdiff_t)row * width, inverse + row, out + (ptrdiff_t)row * width, gain, offset,
                       NORMS, width);
    for (; row < rows; row++)
        normalise_rows(values + (ptrdiff_t)row * width, inverse + row, out + (ptrdiff_t)row * width, gain, offset, 1,
                       width);
}

static void normalise_back(float *slopes, const float *normalised, const float *inverse, const float *gain, int rows,
                           int width) {
    for (int r = 0; r < rows; r++, slopes += width, normalised += width) {
        Lanes sum = {0}, along = {0};
        for (int j = 0; j < width; j += WIDE) {
            *(Lanes *)(slopes + j) *= *(const Lanes *)(gain + j);
            sum += *(Lanes *)(slopes + j);
            along += *(Lanes *)(slopes + j) * *(const Lanes *)(normalised + j);
        }
        const float mean = gns_total(&sum) / (float)width, share = gns_total(&along) / (float)width;
        for (int j = 0; j < width; j += WIDE)
            *(Lanes *)(slopes + j) =
                inverse[r] * (*(Lanes *)(slopes + j) - mean - *(const Lanes *)(normalised + j) * share);
    }
}
