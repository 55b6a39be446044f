/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Statistics of a list of numbers; NaN if it is empty. */
#pragma once

double statistics_mean(const double *values, int count);

/* Moves the values that are not NaN to the front; how many. */
int statistics_known(double *values, int count);

/* Sorts the values; interpolates linearly. fraction: 0.5 for the median, 0.25 and 0.75 for the quartiles. */
double statistics_quantile(double *values, int count, double fraction);
