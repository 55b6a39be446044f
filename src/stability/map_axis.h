/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The axes of a map: one place for each value, whatever the distance of the values. */
#pragma once
#include "chart/gnuplot_page.h"

/* mm: width of the longest label of the values. */
double map_axis_width(const double *values, int count);

/* axis: 'x' or 'y' of the open panel. room: mm that a value has. label NULL: no numbers either. Labels are thinned so that they
   do not touch, to values that are as round as possible. */
void map_axis_write(GnuplotPage *page, char axis, const double *values, int count, double room, const char *label);
