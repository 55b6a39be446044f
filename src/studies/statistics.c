/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mean and quantiles. */
#include "studies/statistics.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>
#include <math.h>

/* Own loop: GSL's running mean rounds differently on machines without long double. */
double statistics_mean(const double *values, int count) {
    double sum = 0;
    for (int i = 0; i < count; i++) sum += values[i];
    return count > 0 ? sum / count : NAN;
}

int statistics_known(double *values, int count) {
    int known = 0;
    for (int i = 0; i < count; i++)
        if (!isnan(values[i])) values[known++] = values[i];
    return known;
}

double statistics_quantile(double *values, int count, double fraction) {
    if (count == 0) return NAN;
    gsl_sort(values, 1, (size_t)count);
    return gsl_stats_quantile_from_sorted_data(values, 1, (size_t)count, fraction);
}
