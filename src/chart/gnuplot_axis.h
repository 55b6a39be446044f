/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Logarithmic axes fitted to the data. */
#pragma once
#include "chart/gnuplot_page.h"

/* The range of the values above 0. */
typedef struct GnuplotRange {
    double least, most;
} GnuplotRange;

GnuplotRange gnuplot_range(void);
void gnuplot_range_include(GnuplotRange *range, double value); /* ignores NaN and values not above 0 */

typedef struct GnuplotAxis {
    LogAxis log;
    double least; /* start of the tics */
    double zero;  /* position of 0, left of the tics; 0: none */
} GnuplotAxis;

/* An axis for the range, clamped to [lowest, highest], at least one decade long. with_zero: adds a position for 0. */
GnuplotAxis gnuplot_axis(GnuplotRange range, double lowest, double highest, bool with_zero);

/* Writes a panel's axis; label NULL: neither label nor numbers. */
void gnuplot_log_axis(GnuplotPage *page, char letter, const GnuplotAxis *axis, const char *label);

/* The position of a value, clamped to the axis. */
double gnuplot_axis_clamp(GnuplotPage *page, const GnuplotAxis *axis, double value);
