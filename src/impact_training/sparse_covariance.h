/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Products C Q of directions Q with the covariance C of the columns of n sparse rows A:

       C Q = A^T (A Q - 1 mean^T Q) / n - mean (sum of the rows of (A Q - 1 mean^T Q))^T / n

   C is never formed. The mean is subtracted from the products A Q and not from the rows, which would lose their
   sparsity. The last term is 0 except for rounding errors, which it cancels if the mean is large. Own code:
   GSL's sparse matrices are in double, multiply a single vector at a time and use one thread; here the bits are the
   same for any number of threads (tests/impact_training/test_principal.c). */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

/* Compressed sparse rows: row i has value[k] in column[k] for begin[i] <= k < begin[i + 1], in any order, each column
   at most once. */
typedef struct SparseRows {
    int rows, columns;
    const int64_t *begin;  /* [rows + 1] */
    const int32_t *column; /* [begin[rows]] */
    const float *value;
} SparseRows;

enum { DIRECTIONS_BLOCK = 16 }; /* directions per pass over the rows: small enough for the cache */

typedef struct SparseCovariance {
    const SparseRows *rows;
    size_t columns, width; /* width: number of directions, a multiple of DIRECTIONS_BLOCK */
    double *mean;          /* [columns] */
    bool *constant;        /* [columns] same value in every row */
    double *centre;        /* [width] mean^T Q */
    double *parts;         /* [parts, columns + 1, width] partial sums of A^T (...); last row: sums of (...) */
} SparseCovariance;

/* Checks the rows and computes their mean; the rows must outlive the covariance. ERROR_INPUT, naming row and column, if
   a column is out of bounds or repeated in a row or a value is not finite; must be freed on failure too. */
bool sparse_covariance_make(SparseCovariance *covariance, const SparseRows *rows, size_t width, Error *error);
void sparse_covariance_free(SparseCovariance *covariance);

/* image = C directions, both [columns, width]; exactly 0 in constant columns. Same bits for any number of threads. */
void sparse_covariance_multiply(SparseCovariance *covariance, const double *directions, double *image);

static inline void add_scaled(double *restrict sums, double scale, const double *restrict numbers, size_t count) {
    for (size_t i = 0; i < count; i++) sums[i] += scale * numbers[i];
}
