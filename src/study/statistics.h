/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Statistics of a list of numbers; NAN if it is empty. */
#pragma once

double statistics_mean(const double *values, int count);

/* Sorts the values, and interpolates between the two nearest. 0.5: median; 0.25 and 0.75: quartiles. */
double statistics_quantile(double *values, int count, double fraction);
