/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "subspace_training/jacobi.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SWEEPS_MAX = 30 }; /* it converges quadratically: ten suffice for hundreds of rows */

/* Entries below this share of the geometric mean of their two diagonal entries are rounding. */
static const double least_share = 1e-15;

typedef struct Rotation {
    double cosine, sine;
} Rotation;

/* Rows p and q of [size, size], x' = c x - s y, y' = s x + c y. */
static void turn_rows(double *matrix, int size, int p, int q, Rotation turn) {
    double *restrict x = matrix + (size_t)p * (size_t)size, *restrict y = matrix + (size_t)q * (size_t)size;
    for (int i = 0; i < size; i++) {
        const double a = x[i], b = y[i];
        x[i] = turn.cosine * a - turn.sine * b;
        y[i] = turn.sine * a + turn.cosine * b;
    }
}

/* The smaller of the two rotations that make entry (p, q) 0. */
static Rotation rotation(double pp, double pq, double qq) {
    const double tau = (qq - pp) / (2 * pq);
    const double tangent = tau >= 0 ? 1 / (tau + sqrt(1 + tau * tau)) : -1 / (-tau + sqrt(1 + tau * tau));
    const double cosine = 1 / sqrt(1 + tangent * tangent);
    return (Rotation){cosine, tangent * cosine};
}

/* Both triangles are kept, so that rows are contiguous: the columns are copies of the turned rows. */
static void rotate(double *matrix, double *vectors, int size, int p, int q) {
    const size_t n = (size_t)size, a = (size_t)p, b = (size_t)q;
    const double pp = matrix[a * n + a], pq = matrix[a * n + b], qq = matrix[b * n + b];
    const Rotation turn = rotation(pp, pq, qq);
    const double shift = turn.sine / turn.cosine * pq;
    turn_rows(matrix, size, p, q, turn);
    turn_rows(vectors, size, p, q, turn);
    matrix[a * n + a] = pp - shift;
    matrix[b * n + b] = qq + shift;
    matrix[a * n + b] = matrix[b * n + a] = 0;
    for (size_t i = 0; i < n; i++) matrix[i * n + a] = matrix[a * n + i], matrix[i * n + b] = matrix[b * n + i];
}

static bool sweep(double *matrix, double *vectors, int size) {
    const size_t n = (size_t)size;
    bool turned = false;
    for (int p = 0; p < size; p++)
        for (int q = p + 1; q < size; q++) {
            const size_t a = (size_t)p, b = (size_t)q;
            const double entry = fabs(matrix[a * n + b]);
            if (!(entry > least_share * sqrt(fabs(matrix[a * n + a] * matrix[b * n + b])) && entry > 1e-200)) continue;
            rotate(matrix, vectors, size, p, q);
            turned = true;
        }
    return turned;
}

static void make_largest_positive(double *vector, int size) {
    double largest = 0;
    for (int i = 0; i < size; i++)
        if (fabs(vector[i]) > fabs(largest)) largest = vector[i];
    for (int i = 0; largest < 0 && i < size; i++) vector[i] = -vector[i];
}

/* Selection sort: of equal values the first stays first. */
static void sort(double *values, double *vectors, double *row, int size) {
    const size_t bytes = (size_t)size * sizeof *row;
    for (int i = 0; i < size; i++) {
        int best = i;
        for (int j = i + 1; j < size; j++)
            if (values[j] > values[best]) best = j;
        double *first = vectors + (size_t)i * (size_t)size, *second = vectors + (size_t)best * (size_t)size;
        if (best != i) {
            const double value = values[i];
            values[i] = values[best];
            values[best] = value;
            memcpy(row, first, bytes);
            memcpy(first, second, bytes);
            memcpy(second, row, bytes);
        }
        make_largest_positive(first, size);
    }
}

bool jacobi_eigenvectors(double *matrix, int size, double *values, double *vectors) {
    const size_t n = (size_t)size;
    double *row = malloc(n * sizeof *row);
    if (row == NULL) return false;
    memset(vectors, 0, n * n * sizeof *vectors);
    for (size_t i = 0; i < n; i++) vectors[i * n + i] = 1;
    for (int i = 0; i < SWEEPS_MAX && sweep(matrix, vectors, size); i++) continue;
    for (size_t i = 0; i < n; i++) values[i] = matrix[i * n + i];
    sort(values, vectors, row, size);
    free(row);
    return true;
}
