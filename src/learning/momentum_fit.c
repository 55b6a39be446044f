/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "learning/scene_training_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PARTS = 8 }; /* of the rows; a fixed number, so that the order of sums does not depend on the threads */

/* A register of two doubles exists on every machine. Without vectors the compiler keeps the sums in memory. */
typedef double Double2 __attribute__((vector_size(16), aligned(sizeof(double)), may_alias));
enum { BLOCK_VECTORS = DIRECTIONS_BLOCK / 2 };

void sparse_covariance_free(SparseCovariance *covariance) {
    free(covariance->mean);
    free(covariance->constant);
    free(covariance->centre);
    free(covariance->parts);
}

typedef struct Column {
    int last, count; /* last row with an entry, counted from 1; number of entries */
    float first;     /* first value */
    bool differs;    /* a later value differs from the first */
} Column;

static bool read_row(SparseCovariance *covariance, int i, Column *columns, Error *error) {
    const SparseRows *rows = covariance->rows;
    for (int64_t k = rows->begin[i]; k < rows->begin[i + 1]; k++) {
        const int32_t at = rows->column[k];
        const float value = rows->value[k];
        if (at < 0 || at >= rows->columns)
            return error_input(error, "sparse rows", "row %d: column %d of %d", i, at, rows->columns);
        if (!isfinite(value)) return error_input(error, "sparse rows", "row %d: column %d is not finite", i, at);
        Column *column = &columns[at];
        if (column->last == i + 1) return error_input(error, "sparse rows", "row %d: column %d is repeated", i, at);
        if (column->count++ == 0) column->first = value;
        column->last = i + 1;
        column->differs |= value != column->first;
        covariance->mean[at] += (double)value;
    }
    return true;
}

static bool read_rows(SparseCovariance *covariance, Error *error) {
    const int rows = covariance->rows->rows;
    Column *columns = calloc(covariance->columns, sizeof *columns);
    bool ok = columns != NULL || error_memory(error, "sparse rows");
    for (int i = 0; ok && i < rows; i++) ok = read_row(covariance, i, columns, error);
    for (size_t j = 0; ok && j < covariance->columns; j++) {
        covariance->constant[j] = columns[j].count == rows && !columns[j].differs;
        covariance->mean[j] /= rows;
    }
    free(columns);
    return ok;
}

bool sparse_covariance_make(SparseCovariance *covariance, const SparseRows *rows, size_t width, Error *error) {
    const size_t columns = (size_t)rows->columns;
    *covariance = (SparseCovariance){.rows = rows, .columns = columns, .width = width};
    covariance->mean = calloc(columns, sizeof *covariance->mean);
    covariance->constant = calloc(columns, sizeof *covariance->constant);
    covariance->centre = calloc(width, sizeof *covariance->centre);
    covariance->parts = calloc(PARTS * (columns + 1) * width, sizeof *covariance->parts);
    if (!covariance->mean || !covariance->constant || !covariance->centre || !covariance->parts)
        return error_memory(error, "sparse rows");
    return read_rows(covariance, error);
}

static inline void add_block(Double2 *sums, double scale, const Double2 *numbers) {
    for (int i = 0; i < BLOCK_VECTORS; i++) sums[i] += scale * numbers[i];
}

/* Sums row^T (row - mean) Q and (row - mean) Q over the rows of a part, for the block of directions at `from`. */
static void sum_part(const SparseCovariance *covariance, const double *directions, int part, size_t from) {
    const SparseRows *rows = covariance->rows;
    const size_t width = covariance->width, columns = covariance->columns;
    double *sums = covariance->parts + (size_t)part * (columns + 1) * width + from;
    for (size_t j = 0; j <= columns; j++) memset(sums + j * width, 0, DIRECTIONS_BLOCK * sizeof *sums);
    const int first = (int)((int64_t)rows->rows * part / PARTS), end = (int)((int64_t)rows->rows * (part + 1) / PARTS);
    for (int i = first; i < end; i++) {
        Double2 product[BLOCK_VECTORS];
        for (int c = 0; c < BLOCK_VECTORS; c++) product[c] = -((const Double2 *)(covariance->centre + from))[c];
        for (int64_t k = rows->begin[i]; k < rows->begin[i + 1]; k++) {
            const double *row = directions + (size_t)rows->column[k] * width + from;
            add_block(product, (double)rows->value[k], (const Double2 *)row);
        }
        for (int64_t k = rows->begin[i]; k < rows->begin[i + 1]; k++)
            add_block((Double2 *)(sums + (size_t)rows->column[k] * width), (double)rows->value[k], product);
        add_block((Double2 *)(sums + columns * width), 1, product);
    }
}

void sparse_covariance_multiply(SparseCovariance *covariance, const double *directions, double *image) {
    const size_t width = covariance->width, columns = covariance->columns, part_size = (columns + 1) * width;
    const int pieces = PARTS * (int)(width / DIRECTIONS_BLOCK);
    memset(covariance->centre, 0, width * sizeof *covariance->centre);
    for (size_t j = 0; j < columns; j++)
        add_scaled(covariance->centre, covariance->mean[j], directions + j * width, width);
#pragma omp parallel for schedule(dynamic, 1)
    for (int piece = 0; piece < pieces; piece++)
        sum_part(covariance, directions, piece % PARTS, (size_t)(piece / PARTS) * DIRECTIONS_BLOCK);
    double *sums = covariance->parts;
    for (int p = 1; p < PARTS; p++) add_scaled(sums, 1, covariance->parts + (size_t)p * part_size, part_size);
    memset(image, 0, columns * width * sizeof *image);
    for (size_t j = 0; j < columns; j++) {
        if (covariance->constant[j]) continue;
        add_scaled(sums + j * width, -covariance->mean[j], sums + columns * width, width);
        add_scaled(image + j * width, 1.0 / covariance->rows->rows, sums + j * width, width);
    }
}
