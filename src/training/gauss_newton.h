/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gauss-Newton products J^T J and J^T u of the Jacobian J [rows * outputs, parameters] of the predictions. Summed block
   by block; J is never stored. */
#pragma once
#include "training/samples.h"

typedef struct GaussNewton GaussNewton;

/* Work space for networks of this shape; `shape` must outlive it. */
GaussNewton *gauss_newton_create(const Network *shape, Error *error);
void gauss_newton_destroy(GaussNewton *work);

/* u[blocks, outputs, BLOCK_ROWS]: the layout of loss_residuals(), 0 in padding rows. Fills jtu[parameters] and, if jtj
   != NULL, the lower triangle of jtj[parameters, parameters]. Same bits for any number of threads. */
void gauss_newton_sum(GaussNewton *work, const Samples *samples, const double *parameters, const double *u, double *jtu,
                      double *jtj);
