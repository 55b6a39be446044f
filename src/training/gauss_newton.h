/* SPDX-License-Identifier: GPL-3.0-or-later */
/* J^T J and J^T u, where J [rows * outputs, parameters] holds the derivatives of the predictions: what a
   least squares method needs of J, summed block by block without ever storing it. */
#pragma once
#include "training/samples.h"

typedef struct GaussNewton GaussNewton;

/* Work space for networks of this shape, which must outlive it. */
GaussNewton *gauss_newton_create(const Network *shape, Error *error);
void gauss_newton_destroy(GaussNewton *work);

/* u[blocks, outputs, BLOCK_ROWS], the layout of loss_residuals(), 0 in the rows that fill up. Fills
   jtu[parameters] and, unless jtj is NULL, the lower half of jtj[parameters, parameters]. The same bits at
   any number of threads. */
void gauss_newton_sum(GaussNewton *work, const Samples *samples, const double *parameters, const double *u, double *jtu,
                      double *jtj);
