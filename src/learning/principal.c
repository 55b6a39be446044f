/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Principal components: second moments of rows, and their eigenvectors by GSL. */
#include "learning/principal.h"

#include "base/base.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <stdlib.h>

/* Of the rows; a fixed number, so that the order of sums does not depend on the number of threads. */
enum { PARTS = 8 };

static bool symmetric_eigenvectors(double *matrix, size_t size, double *values, double *vectors) {
    gsl_set_error_handler_off(); /* its default aborts */
    gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(size);
    if (work == NULL) return false;
    gsl_matrix_view of = gsl_matrix_view_array(matrix, size, size), axes = gsl_matrix_view_array(vectors, size, size);
    gsl_vector_view found = gsl_vector_view_array(values, size);
    gsl_eigen_symmv(&of.matrix, &found.vector, &axes.matrix, work);
    gsl_eigen_symmv_free(work);
    gsl_eigen_symmv_sort(&found.vector, &axes.matrix, GSL_EIGEN_SORT_VAL_DESC);
    gsl_matrix_transpose(&axes.matrix);
    for (double *vector = vectors; vector < vectors + size * size; vector += size) {
        double largest = 0;
        for (size_t i = 0; i < size; i++)
            if (fabs(vector[i]) > fabs(largest)) largest = vector[i];
        for (size_t i = 0; largest < 0 && i < size; i++) vector[i] = -vector[i];
    }
    return true;
}

void principal_mean(const PrincipalRows *rows, double *mean) {
    for (int j = 0; j < rows->columns; j++) {
        double sum = 0;
        for (size_t r = 0; r < rows->count; r++) sum += (double)rows->numbers[r * (size_t)rows->columns + (size_t)j];
        mean[j] = sum / (double)rows->count;
    }
}

bool principal_components(const PrincipalRows *rows, const double *centre, double *values, double *vectors,
                          Error *error) {
    const size_t columns = (size_t)rows->columns, size = columns * columns, group = rows->group > 0 ? rows->group : 1;
    double *parts = calloc(PARTS * (size + columns), sizeof *parts), *scratch = parts + PARTS * size;
    if (parts == NULL) return error_memory(error, "principal components");
#pragma omp parallel for schedule(static, 1)
    for (size_t part = 0; part < PARTS; part++) {
        double *u = scratch + part * columns, *moments = parts + part * size;
        for (size_t r = 0; r < rows->count; r++) {
            if (r / group % PARTS != part) continue;
            const float *row = rows->numbers + r * columns;
            for (size_t j = 0; j < columns; j++) u[j] = (double)row[j] - centre[j];
            for (size_t i = 0; i < columns; i++) {
                double *restrict to = moments + i * columns;
                if (u[i] == 0) continue;
                for (size_t j = 0; j <= i; j++) to[j] += u[i] * u[j];
            }
        }
    }
    bool finite = true; /* GSL does not end with NaN */
    for (size_t i = 0; i < columns; i++)
        for (size_t j = 0; j <= i; j++) {
            for (size_t part = 1; part < PARTS; part++) parts[i * columns + j] += parts[part * size + i * columns + j];
            parts[j * columns + i] = parts[i * columns + j];
            finite = finite && isfinite(parts[i * columns + j]);
        }
    const bool ok =
        finite ? symmetric_eigenvectors(parts, columns, values, vectors) || error_memory(error, "principal components")
               : error_input(error, "principal components", "a number is NaN or infinite");
    free(parts);
    return ok;
}
