/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Mean and quantiles; curves of error over time. */
#include "studies/statistics.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>
#include <math.h>
#include <stdlib.h>

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

static int compare_points(const void *left, const void *right) {
    const CurvePoint *a = left, *b = right;
    if (a->us != b->us) return a->us < b->us ? -1 : 1;
    return (a->error > b->error) - (a->error < b->error);
}

int error_curve_front(CurvePoint *points, int count) {
    int kept = 0;
    qsort(points, (size_t)count, sizeof *points, compare_points);
    for (int i = 0; i < count; i++)
        if (kept == 0 || points[i].error < points[kept - 1].error) points[kept++] = points[i];
    return kept;
}

double error_curve_at(const CurvePoint *front, int count, double us, CurveReach *reach) {
    int after = 0;
    while (after < count && front[after].us < us) after++;
    if (after < count && front[after].us == us) {
        *reach = CURVE_WITHIN;
        return front[after].error;
    }
    *reach = after == 0 ? CURVE_BEFORE : after == count ? CURVE_BEYOND : CURVE_WITHIN;
    if (*reach == CURVE_BEFORE) return NAN;
    if (*reach == CURVE_BEYOND) return front[count - 1].error;
    const CurvePoint *a = &front[after - 1], *b = &front[after];
    const double share = log(us / a->us) / log(b->us / a->us);
    return a->error * pow(b->error / a->error, share);
}
