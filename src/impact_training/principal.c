/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "impact_training/principal.h"

#include <float.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    OVERSAMPLING = 8,    /* minimum number of extra directions; the source recommends 5 to 10 */
    POWER_ITERATIONS = 4 /* one pass over the rows each; the source's 2 suffice only if the spectrum decays fast */
};

/* Relative to the largest variance. Smaller variances are rounding errors of the float rows. */
static const double least_variance = 1e-10;

/* Relative to the longest column. A shorter remainder is rounding: the column is in the span of the others. */
static const double least_length = 1e-14;

typedef struct Fit {
    SparseCovariance covariance;
    size_t columns, width; /* width: number of directions; those beyond the rank become 0 */
    double *basis, *image; /* [columns, width] Q and C Q */
    double *products;      /* [width] work space */
    gsl_rng *generator;
    gsl_matrix *small, *axes; /* [width, width] Q^T C Q and its eigenvectors */
    gsl_vector *variances;
    gsl_eigen_symmv_workspace *eigen;
} Fit;

static void fit_free(Fit *fit) {
    sparse_covariance_free(&fit->covariance);
    free(fit->basis);
    free(fit->image);
    free(fit->products);
    if (fit->generator != NULL) gsl_rng_free(fit->generator);
    if (fit->small != NULL) gsl_matrix_free(fit->small);
    if (fit->axes != NULL) gsl_matrix_free(fit->axes);
    if (fit->variances != NULL) gsl_vector_free(fit->variances);
    if (fit->eigen != NULL) gsl_eigen_symmv_free(fit->eigen);
}

static bool fit_make(Fit *fit, const SparseRows *rows, int wanted, Error *error) {
    gsl_set_error_handler_off(); /* its default aborts */
    const size_t columns = (size_t)rows->columns, least = (size_t)wanted + OVERSAMPLING;
    const size_t width = (least + DIRECTIONS_BLOCK - 1) / DIRECTIONS_BLOCK * DIRECTIONS_BLOCK;
    *fit = (Fit){.columns = columns, .width = width};
    if (!sparse_covariance_make(&fit->covariance, rows, width, error)) return false;
    fit->basis = calloc(columns * width, sizeof *fit->basis);
    fit->image = calloc(columns * width, sizeof *fit->image);
    fit->products = calloc(width, sizeof *fit->products);
    fit->generator = gsl_rng_alloc(gsl_rng_mt19937);
    fit->small = gsl_matrix_calloc(width, width);
    fit->axes = gsl_matrix_calloc(width, width);
    fit->variances = gsl_vector_calloc(width);
    fit->eigen = gsl_eigen_symmv_alloc(width);
    return (fit->basis && fit->image && fit->products && fit->generator && fit->small && fit->axes && fit->variances &&
            fit->eigen) ||
           error_memory(error, "principal components");
}

static void start(Fit *fit, uint64_t seed) {
    gsl_rng_set(fit->generator, (unsigned long)((seed ^ seed >> 32) & UINT32_MAX)); /* it takes 32 bits */
    for (size_t i = 0; i < fit->columns * fit->width; i++) fit->basis[i] = gsl_ran_gaussian_ziggurat(fit->generator, 1);
}

/* products[k] = dot product of columns j and k of the basis, for k >= from. */
static void multiply_columns(Fit *fit, size_t j, size_t from) {
    memset(fit->products, 0, fit->width * sizeof *fit->products);
    for (size_t i = 0; i < fit->columns; i++) {
        const double *row = fit->basis + i * fit->width;
        add_scaled(fit->products + from, row[j], row + from, fit->width - from);
    }
}

static double longest_column(const Fit *fit, double *squares) {
    double largest = 0;
    memset(squares, 0, fit->width * sizeof *squares);
    for (size_t i = 0; i < fit->columns * fit->width; i++) squares[i % fit->width] += fit->basis[i] * fit->basis[i];
    for (size_t k = 0; k < fit->width; k++) largest = fmax(largest, squares[k]);
    return sqrt(largest);
}

/* Modified Gram-Schmidt on the columns of the basis, repeated once to remove the rounding errors of the first round.
   Columns in the span of earlier ones become 0. */
static void orthonormalise(Fit *fit) {
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
static void find_axes(Fit *fit) {
    for (size_t a = 0; a < fit->width; a++) {
        double *row = gsl_matrix_ptr(fit->small, a, 0);
        for (size_t j = 0; j < fit->columns; j++)
            add_scaled(row, fit->basis[j * fit->width + a], fit->image + j * fit->width, fit->width);
    }
    gsl_eigen_symmv(fit->small, fit->variances, fit->axes, fit->eigen);
    gsl_eigen_symmv_sort(fit->variances, fit->axes, GSL_EIGEN_SORT_VAL_DESC);
}

/* scale: 1 / standard deviation of the component. */
static void write_component(const Fit *fit, size_t c, double scale, Projection *projection) {
    const size_t to = (size_t)projection->to;
    float largest = 0;
    for (size_t j = 0; j < fit->columns; j++) {
        double sum = 0;
        for (size_t a = 0; a < fit->width; a++) sum += fit->basis[j * fit->width + a] * gsl_matrix_get(fit->axes, a, c);
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

static void write_components(const Fit *fit, Projection *projection) {
    const size_t to = (size_t)projection->to;
    memset(projection->rows, 0, fit->columns * to * sizeof *projection->rows);
    memset(projection->centre, 0, to * sizeof *projection->centre);
    /* Below FLT_MIN^2 the scaled direction would overflow float. */
    const double least = fmax(least_variance * gsl_vector_get(fit->variances, 0), (double)FLT_MIN * (double)FLT_MIN);
    for (size_t c = 0; c < to; c++) {
        const double variance = gsl_vector_get(fit->variances, c);
        if (variance > least) write_component(fit, c, 1 / sqrt(variance), projection);
    }
}

static void fit_components(Fit *fit, uint64_t seed) {
    start(fit, seed);
    for (int pass = 0; pass <= POWER_ITERATIONS; pass++) {
        if (pass > 0) memcpy(fit->basis, fit->image, fit->columns * fit->width * sizeof *fit->basis);
        orthonormalise(fit);
        sparse_covariance_multiply(&fit->covariance, fit->basis, fit->image);
    }
    find_axes(fit);
}

bool principal_fit(const SparseRows *rows, uint64_t seed, Projection *projection, Error *error) {
    if (rows->rows < 1 || rows->columns < 1 || projection->from != rows->columns || projection->to < 1)
        return error_input(error, "principal components", "%d rows of %d columns for a projection of %d to %d",
                           rows->rows, rows->columns, projection->from, projection->to);
    Fit fit;
    const bool ok = fit_make(&fit, rows, projection->to, error);
    if (ok) {
        fit_components(&fit, seed);
        write_components(&fit, projection);
    }
    fit_free(&fit);
    return ok;
}
