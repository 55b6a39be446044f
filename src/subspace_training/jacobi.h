/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Eigenvectors of a symmetric matrix by cyclic Jacobi rotations, with the same bits on every machine; a library's depend
   on how it was compiled. Source: Golub, Van Loan, "Matrix Computations" (2013), section 8.5. */
#pragma once
#include <stdbool.h>

/* matrix[size, size] is symmetric and is destroyed. values[size] falling; vectors[size, size]: row i belongs to value i,
   has length 1, and its largest entry is positive. False when memory is short. */
bool jacobi_eigenvectors(double *matrix, int size, double *values, double *vectors);
