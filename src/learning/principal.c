/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Principal components of sparse rows: products with their covariance, and the subspace iteration that needs no
   more. */
#include "base/base.h"
#include "learning/learning.h"
#include "learning/scene_training_internal.h"

#include <float.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_randist.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void make_largest_positive(double *vector, size_t size) {
    double largest = 0;
    for (size_t i = 0; i < size; i++)
        if (fabs(vector[i]) > fabs(largest)) largest = vector[i];
    for (size_t i = 0; largest < 0 && i < size; i++) vector[i] = -vector[i];
}

bool symmetric_eigenvectors(double *matrix, size_t size, double *values, double *vectors) {
    gsl_set_error_handler_off(); /* its default aborts */
    gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(size);
    if (work == NULL) return false;
    gsl_matrix_view of = gsl_matrix_view_array(matrix, size, size), axes = gsl_matrix_view_array(vectors, size, size);
    gsl_vector_view found = gsl_vector_view_array(values, size);
    gsl_eigen_symmv(&of.matrix, &found.vector, &axes.matrix, work);
    gsl_eigen_symmv_free(work);
    gsl_eigen_symmv_sort(&found.vector, &axes.matrix, GSL_EIGEN_SORT_VAL_DESC);
    gsl_matrix_transpose(&axes.matrix);
    for (size_t i = 0; i < size; i++) make_largest_positive(vectors + i * size, size);
    return true;
}

enum { PARTS = 8 }; /* of the rows; a fixed number, so that the order of sums does not depend on the threads */

/* A register of two doubles exists on every machine. Without vectors the compiler keeps the sums in memory. */
typedef double Double2 __attribute__((vector_size(16), aligned(sizeof(double)), may_alias));
enum { BLOCK_VECTORS = DIRECTIONS_BLOCK / 2 };

void sparse_covariance_free(SparseCovariance *covariance) { free(covariance->mean); }

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
    const size_t parts = PARTS * (columns + 1) * width;
    double *block = calloc(1, (columns + width + parts) * sizeof *block + columns);
    if (block == NULL) return error_memory(error, "sparse rows");
    covariance->mean = block;
    covariance->centre = covariance->mean + columns;
    covariance->parts = covariance->centre + width;
    covariance->constant = (bool *)(covariance->parts + parts);
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

enum {
    OVERSAMPLING = 8,    /* minimum number of extra directions; the source recommends 5 to 10 */
    POWER_ITERATIONS = 4 /* one pass over the rows each; the source's 2 suffice only if the spectrum decays fast */
};

/* Relative to the largest variance. Smaller variances are rounding errors of the float rows. */
static const double least_variance = 1e-10;

/* Relative to the longest column. A shorter remainder is rounding: the column is in the span of the others. */
static const double least_length = 1e-14;

typedef struct Principal {
    SparseCovariance covariance;
    size_t columns, width; /* width: number of directions; those beyond the rank become 0 */
    double *basis, *image; /* [columns, width] Q and C Q */
    double *products;      /* [width] work space */
    double *small, *axes;  /* [width, width] Q^T C Q and its eigenvectors */
    double *variances;     /* [width] */
    gsl_rng *generator;
} Principal;

static void principal_free(Principal *fit) {
    sparse_covariance_free(&fit->covariance);
    free(fit->basis);
    if (fit->generator != NULL) gsl_rng_free(fit->generator);
}

static bool fit_make(Principal *fit, const SparseRows *rows, int wanted, Error *error) {
    gsl_set_error_handler_off(); /* its default aborts */
    const size_t columns = (size_t)rows->columns, least = (size_t)wanted + OVERSAMPLING;
    const size_t width = (least + DIRECTIONS_BLOCK - 1) / DIRECTIONS_BLOCK * DIRECTIONS_BLOCK;
    *fit = (Principal){.columns = columns, .width = width};
    if (!sparse_covariance_make(&fit->covariance, rows, width, error)) return false;
    fit->basis = calloc((2 * columns + 2 * width + 2) * width, sizeof *fit->basis);
    fit->generator = gsl_rng_alloc(gsl_rng_mt19937);
    if (fit->basis == NULL || fit->generator == NULL) return error_memory(error, "principal components");
    fit->image = fit->basis + columns * width;
    fit->small = fit->image + columns * width;
    fit->axes = fit->small + width * width;
    fit->variances = fit->axes + width * width;
    fit->products = fit->variances + width;
    return true;
}

static void principal_start(Principal *fit, uint64_t seed) {
    gsl_rng_set(fit->generator, (unsigned long)((seed ^ seed >> 32) & UINT32_MAX)); /* it takes 32 bits */
    for (size_t i = 0; i < fit->columns * fit->width; i++) fit->basis[i] = gsl_ran_gaussian_ziggurat(fit->generator, 1);
}

/* products[k] = dot product of columns j and k of the basis, for k >= from. */
static void multiply_columns(Principal *fit, size_t j, size_t from) {
    memset(fit->products, 0, fit->width * sizeof *fit->products);
    for (size_t i = 0; i < fit->columns; i++) {
        const double *row = fit->basis + i * fit->width;
        add_scaled(fit->products + from, row[j], row + from, fit->width - from);
    }
}

static double longest_column(const Principal *fit, double *squares) {
    double largest = 0;
    memset(squares, 0, fit->width * sizeof *squares);
    for (size_t i = 0; i < fit->columns * fit->width; i++) squares[i % fit->width] += fit->basis[i] * fit->basis[i];
    for (size_t k = 0; k < fit->width; k++) largest = fmax(largest, squares[k]);
    return sqrt(largest);
}

/* Modified Gram-Schmidt on the columns of the basis, repeated once to remove the rounding errors of the first round.
   Columns in the span of earlier ones become 0. */
static void orthonormalise(Principal *fit) {
    for (int round = 0; round < 2; round++) {
        const double least = least_length * longest_column(fit, fit->products);
        for (size_t j = 0; j < fit->width; j++) {
            multiply_columns(fit, j, j);
            const double length = sqrt(fit->products[j]), scale = length > least ? 1 / length : 0;
            for (size_t i = 0; i < fit->columns; i++) {
                double *row = fit->basis + i * fit->width;
                row[j] *= scale;
                add_scaled(row + j + 1, -row[j] * scale, fit->products + j + 1, fit->width - j - 1);
            }
        }
    }
}

/* Eigenvectors of Q^T C Q, strongest first. */
static bool find_axes(Principal *fit) {
    for (size_t a = 0; a < fit->width; a++)
        for (size_t j = 0; j < fit->columns; j++)
            add_scaled(fit->small + a * fit->width, fit->basis[j * fit->width + a], fit->image + j * fit->width,
                       fit->width);
    return symmetric_eigenvectors(fit->small, fit->width, fit->variances, fit->axes);
}

/* scale: 1 / standard deviation of the component. */
static void write_component(const Principal *fit, size_t c, double scale, Projection *projection) {
    const size_t to = (size_t)projection->to;
    float largest = 0;
    for (size_t j = 0; j < fit->columns; j++) {
        double sum = 0;
        for (size_t a = 0; a < fit->width; a++) sum += fit->basis[j * fit->width + a] * fit->axes[c * fit->width + a];
        const float number = projection->rows[j * to + c] = (float)(scale * sum);
        if (fabsf(number) > fabsf(largest)) largest = number;
    }
    double centre = 0;
    for (size_t j = 0; j < fit->columns; j++) {
        if (largest < 0) projection->rows[j * to + c] *= -1;
        centre += fit->covariance.mean[j] * (double)projection->rows[j * to + c];
    }
    projection->centre[c] = (float)centre;
}

static void write_components(const Principal *fit, Projection *projection) {
    const size_t to = (size_t)projection->to;
    memset(projection->rows, 0, fit->columns * to * sizeof *projection->rows);
    memset(projection->centre, 0, to * sizeof *projection->centre);
    /* Below FLT_MIN^2 the scaled direction would overflow float. */
    const double least = fmax(least_variance * fit->variances[0], (double)FLT_MIN * (double)FLT_MIN);
    for (size_t c = 0; c < to; c++) {
        const double variance = fit->variances[c];
        if (variance > least) write_component(fit, c, 1 / sqrt(variance), projection);
    }
}

static bool fit_components(Principal *fit, uint64_t seed) {
    principal_start(fit, seed);
    for (int pass = 0; pass <= POWER_ITERATIONS; pass++) {
        if (pass > 0) memcpy(fit->basis, fit->image, fit->columns * fit->width * sizeof *fit->basis);
        orthonormalise(fit);
        sparse_covariance_multiply(&fit->covariance, fit->basis, fit->image);
    }
    return find_axes(fit);
}

bool principal_fit(const SparseRows *rows, uint64_t seed, Projection *projection, Error *error) {
    if (rows->rows < 1 || rows->columns < 1 || projection->from != rows->columns || projection->to < 1)
        return error_input(error, "principal components", "%d rows of %d columns for a projection of %d to %d",
                           rows->rows, rows->columns, projection->from, projection->to);
    Principal fit;
    const bool ok = fit_make(&fit, rows, projection->to, error) &&
                    (fit_components(&fit, seed) || error_memory(error, "principal components"));
    if (ok) write_components(&fit, projection);
    principal_free(&fit);
    return ok;
}
