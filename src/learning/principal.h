/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Principal components of rows.

       const PrincipalRows rows = {numbers, count, columns, .group = 1};
       principal_mean(&rows, mean);
       principal_components(&rows, mean, values, vectors, error); */
#pragma once
#include "base/base.h"

#include <stddef.h>

typedef struct PrincipalRows {
    const float *numbers; /* [count, columns] */
    size_t count;
    int columns;
    size_t group; /* rows that one part of the sums takes together; 0: 1 */
} PrincipalRows;

void principal_mean(const PrincipalRows *rows, double *mean);

/* Eigenvectors of the sum over the rows of u u^T, u a row less the centre[columns]: values[columns] falling,
   vectors[columns, columns]: row i belongs to value i, has length 1, and its largest entry is positive. By GSL, in a
   time that grows with the cube of the columns, and with 64 bytes for each pair of them: 1,300 take some ten seconds
   and 110 MB. The same bits for any number of threads; another version of GSL may have others. ERROR_INPUT where a
   number is NaN or infinite. */
bool principal_components(const PrincipalRows *rows, const double *centre, double *values, double *vectors,
                          Error *error);
