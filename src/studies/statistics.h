/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Statistics of lists of numbers, and curves of error over time. */
#pragma once

/* Of a list; NaN if it is empty. */

double statistics_mean(const double *values, int count);

/* Moves the values that are not NaN to the front; how many. */
int statistics_known(double *values, int count);

/* Sorts the values; interpolates linearly. fraction: 0.5 for the median, 0.25 and 0.75 for the quartiles. */
double statistics_quantile(double *values, int count, double fraction);

/* Curves of error over time: those of a method's runs with several settings. */

typedef struct CurvePoint {
    double us, error; /* microseconds; m/s; both greater than 0 */
} CurvePoint;

/* Where a time lies on a curve: before its first point, between its points, or beyond the last. */
typedef enum CurveReach { CURVE_BEFORE, CURVE_WITHIN, CURVE_BEYOND } CurveReach;

/* Sorts the points and keeps those that no other beats in both: rising times, falling errors. Returns their number. */
int error_curve_front(CurvePoint *points, int count);

/* The error of such a front at a time: a straight line in log error over log time between neighbours. NaN before
   the first point, as no setting is that quick. Beyond the last point it is the last point's error. count >= 1. */
double error_curve_at(const CurvePoint *front, int count, double us, CurveReach *reach);

/* m/s: smaller errors count as equal. */
#define PARETO_RESOLUTION 1e-4
