/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The axis of a study in the borders figure, in mm from the panel's left edge: tiles keep their size on a logarithmic
   axis too. */
#pragma once
#include "chart/gnuplot_page.h"
#include "stability/stability_table.h"

typedef struct BorderAxis {
    bool logarithmic;
    double least, most; /* range of the study's values, widened if too narrow; the axis has a margin at both ends */
    double width;       /* mm */
    bool falling;       /* smaller values are harder: most methods hold above their border and fail below */
    char label[STABILITY_TEXT_SIZE];
} BorderAxis;

/* Margin at both ends for the marks of methods that hold over the whole range or never. */
#define BORDER_AXIS_ROOM 4.4 /* mm */

/* The axis of the study of row `first`. */
BorderAxis border_axis(const BorderTable *table, int first, double width);

/* mm from the panel's left edge. */
double border_axis_place(const BorderAxis *axis, double value);

/* Writes the axis to the open panel. */
void border_axis_write(const BorderAxis *axis, GnuplotPage *page);
