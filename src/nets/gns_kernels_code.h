/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The code of GnsKernels (kernels.h); included by kernels_code.h. Every sum runs over its items in rising order. */
#include "nets/kernels.h"

/* ROWS_AT_ONCE: as many rows as have the sums of COLUMNS columns in eight registers, of FLOATS (kernels_code.h). */
enum { WIDE = 8, COLUMNS = 2 * WIDE, VECTORS = COLUMNS / FLOATS, ROWS_AT_ONCE = 8 / VECTORS };

/* Two registers where one holds four floats. */
typedef float Lanes __attribute__((vector_size(WIDE * sizeof(float)), aligned(sizeof(float)), may_alias));

/* The variance of a row of equal numbers is 0. */
static const float least_variance = 1e-5f;

/* out[rows, columns] += a b[depth, columns], a[row, d] at a[row * row_step + d * depth_step], for COLUMNS columns and
   `rows` rows, a constant after inlining. */
static inline __attribute__((always_inline)) void multiply_block(float *out, int columns, const float *a,
                                                                 ptrdiff_t row_step, ptrdiff_t depth_step,
                                                                 const float *b, int depth, const int rows) {
    Floats sums[ROWS_AT_ONCE][VECTORS];
    for (int r = 0; r < rows; r++)
        for (int v = 0; v < VECTORS; v++) sums[r][v] = *(const Floats *)(out + (ptrdiff_t)r * columns + v * FLOATS);
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

static void multiply_add(float *out, int rows, int columns, const float *a, ptrdiff_t row_step, ptrdiff_t depth_step,
                         const float *b, int depth) {
    int row = 0, column;
    for (; row + ROWS_AT_ONCE <= rows; row += ROWS_AT_ONCE)
        for (column = 0; column + COLUMNS <= columns; column += COLUMNS)
            multiply_block(out + (ptrdiff_t)row * columns + column, columns, a + row * row_step, row_step, depth_step,
                           b + column, depth, ROWS_AT_ONCE);
    for (; row < rows; row++)
        for (column = 0; column + COLUMNS <= columns; column += COLUMNS)
            multiply_block(out + (ptrdiff_t)row * columns + column, columns, a + row * row_step, row_step, depth_step,
                           b + column, depth, 1);
    for (row = 0; row < rows; row++)
        for (column = columns - columns % COLUMNS; column < columns; column++) {
            float sum = out[(ptrdiff_t)row * columns + column];
            for (int d = 0; d < depth; d++)
                sum += a[row * row_step + d * depth_step] * b[(ptrdiff_t)d * columns + column];
            out[(ptrdiff_t)row * columns + column] = sum;
        }
}

static void gns_multiply(float *out, const float *in, const float *weights, const float *biases, int rows, int inputs,
                         int outputs) {
    for (int r = 0; biases != NULL && r < rows; r++)
        for (int j = 0; j < outputs; j++) out[(ptrdiff_t)r * outputs + j] = biases[j];
    multiply_add(out, rows, outputs, in, inputs, 1, weights, inputs);
}

static void gns_add_gradient(float *gradient, const float *in, const float *slopes, int rows, int inputs, int outputs) {
    multiply_add(gradient, inputs, outputs, in, 1, inputs, slopes, rows);
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

static void normalise(float *values, float *inverse, float *out, const float *gain, const float *offset, int rows,
                      int width) {
    for (int r = 0; r < rows; r++, values += width, out += width) {
        Lanes sum = {0}, squares = {0};
        for (int j = 0; j < width; j += WIDE) sum += *(Lanes *)(values + j);
        const float mean = gns_total(&sum) / (float)width;
        for (int j = 0; j < width; j += WIDE) {
            *(Lanes *)(values + j) -= mean;
            squares += *(Lanes *)(values + j) * *(Lanes *)(values + j);
        }
        inverse[r] = 1.0f / sqrtf(gns_total(&squares) / (float)width + least_variance);
        for (int j = 0; j < width; j += WIDE) {
            *(Lanes *)(values + j) *= inverse[r];
            *(Lanes *)(out + j) = *(Lanes *)(values + j) * *(const Lanes *)(gain + j) + *(const Lanes *)(offset + j);
        }
    }
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
