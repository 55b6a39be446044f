/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whitened principal components of sparse rows, the inputs of a slot network (network/slot_network.h). Source: Halko,
   Martinsson, Tropp, "Finding Structure with Randomness" (2011), algorithm 4.4, randomised subspace iteration. */
#pragma once
#include "common/error.h"
#include "impact_training/sparse_covariance.h"
#include "network/slot_network.h"

/* Fits a projection, allocated by the caller with from = columns and to = number of components. Over the rows,
   components have mean 0, variance 1 (divisor: number of rows) and no correlation, strongest first. The largest entry
   of each direction is positive. Components beyond the rank, or with less than 1e-10 of the largest variance, are
   always 0; constant columns contribute nothing. Same bits for any number of threads.

   Whitening is always exact. If the variances decay slowly beyond the last component, the directions are not exactly
   the strongest ones, but explain nearly as much variance.

   ERROR_INPUT if there are no rows, a column is out of bounds or repeated in a row, or a value is not finite; the
   projection is then unchanged. */
bool principal_fit(const SparseRows *rows, uint64_t seed, Projection *projection, Error *error);
