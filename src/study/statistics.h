/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Of a list of numbers; NAN of an empty one. */
#pragma once

double statistics_mean(const double *values, int count);

/* Sorts the values, and interpolates between the two nearest: 0.5 is the median, 0.25 and 0.75 are the quartiles. */
double statistics_quantile(double *values, int count, double fraction);
