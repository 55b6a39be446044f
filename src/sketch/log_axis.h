/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A logarithmic axis, placed on the page. */
#pragma once
#include <stdbool.h>
#include <stdio.h>

typedef struct LogAxis {
    double low, high; /* ends, in the axis's unit */
    double from, to;  /* where they lie on the page, mm */
    bool powers;      /* decades are named 10^{-5}, in gnuplot's enhanced text, and not 1e-05 */
} LogAxis;

/* Ends for values of [least, most], both above 0: some room on either side, and a decade
   at least, so that it has tics. */
LogAxis log_axis(double least, double most);

double log_axis_place(const LogAxis *axis, double value);

/* Writes gnuplot's `set xtics` (or y): each decade, and 2 and 5 in between where the axis is short; minor ones
   without a label. Of more than eight decades some have none, either. */
void log_axis_put_tics(const LogAxis *axis, char letter, bool labelled, FILE *script);
