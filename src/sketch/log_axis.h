/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A logarithmic axis on the page. */
#pragma once
#include <stdbool.h>
#include <stdio.h>

typedef struct LogAxis {
    double low, high; /* ends, in the axis's unit */
    double from, to;  /* positions of the ends on the page, mm */
    bool powers;      /* labels are 10^{-5}, in gnuplot's enhanced text, instead of 1e-05 */
} LogAxis;

/* An axis for values in [least, most], both above 0, with padding on both sides and at least one decade, so that it
   has tics. */
LogAxis log_axis(double least, double most);

double log_axis_place(const LogAxis *axis, double value);

/* Writes gnuplot's `set xtics` (or ytics): decades, and 2 and 5 on a short axis; minor tics without labels. Beyond
   eight decades some are not labelled. */
void log_axis_write_tics(const LogAxis *axis, char letter, bool labelled, FILE *script);
