/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The covariance C of the columns of sparse rows A, as something to multiply directions Q with:

       C Q = A^T (A Q - 1 mean^T Q) / n - mean (sum of A Q - 1 mean^T Q)^T / n

   C is never formed. The mean is taken from the products with the directions; taken from the rows it would fill them.
   The last term is 0 but for rounding; without it a large mean would cost digits. Own code: GSL's sparse matrices are
   in double, multiply a single vector at a time and use one thread; here the bits are the same for any number of
   threads (tests/impact_training/test_principal.c). */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

/* Rows of numbers, most of which may be 0: row i has value[k] in column[k] for begin[i] <= k < begin[i + 1], in any
   order, each column at most once. */
typedef struct SparseRows {
    int rows, columns;
    const int64_t *begin;  /* [rows + 1] */
    const int32_t *column; /* [begin[rows]] */
    const float *value;
} SparseRows;

enum { DIRECTIONS_BLOCK = 16 }; /* go through the rows at a time: what they touch stays in the cache */

typedef struct SparseCovariance {
    const SparseRows *rows;
    size_t columns, width; /* width: number of directions, a multiple of DIRECTIONS_BLOCK */
    double *mean;          /* [columns] */
    bool *still;           /* [columns] the same number in every row */
    double *centre;        /* [width] the mean's product with the directions */
    double *parts;         /* [parts, columns + 1, width] sums, and in the last row those of the products */
} SparseCovariance;

/* Reads the rows, which have to outlive it, once. ERROR_INPUT with the place where a column is out of bounds or comes
   twice in a row or a value is not finite; there is something to free in any case. */
bool sparse_covariance_make(SparseCovariance *covariance, const SparseRows *rows, size_t width, Error *error);
void sparse_covariance_free(SparseCovariance *covariance);

/* image = C directions, both [columns, width]; exactly 0 in columns that never change. The same bits at any number of
   threads. */
void sparse_covariance_multiply(SparseCovariance *covariance, const double *directions, double *image);

/* sums[i] += scale * numbers[i] for i < count */
static inline void add_scaled(double *restrict sums, double scale, const double *restrict numbers, size_t count) {
    for (size_t i = 0; i < count; i++) sums[i] += scale * numbers[i];
}
