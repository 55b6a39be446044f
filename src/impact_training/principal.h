/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Principal components of sparse rows, as inputs of a network (network/slot_network.h): directions along which the rows
   vary most. Source: Halko, Martinsson, Tropp, "Finding Structure with Randomness" (2011), algorithm 4.4, randomised
   subspace iteration. */
#pragma once
#include "common/error.h"
#include "impact_training/sparse_covariance.h"
#include "network/slot_network.h"

/* Fits a projection (made by the caller, from = columns, to = as many components as wanted), so that its components have
   mean 0, are uncorrelated and have variance 1 over the rows (sums divided by their number), strongest first. The
   largest number of each direction is positive. Components beyond the rank, or with less than 1e-10 of the largest
   variance, are 0 always; a column that never changes has no part in any. Same bits at any number of threads.

   Uncorrelated with variance 1 they are in any case. That they are the strongest holds as far as the variances fall off
   behind the last one: where they hardly do, what is caught is nearly as much, but not the same directions.

   ERROR_INPUT where there is no row, a column is out of bounds or twice in a row, or a value is not finite; the
   projection is then as it was. */
bool principal_fit(const SparseRows *rows, uint64_t seed, Projection *projection, Error *error);
