/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The axis of a study in the figure of borders: in mm from its panel's left edge, so that tiles keep their size on a
   logarithmic one, too. */
#pragma once
#include "chart/gnuplot_page.h"
#include "stability/stability_table.h"

typedef struct BorderAxis {
    bool logarithmic;
    double least, most; /* of the study's values, or farther apart: within the axis, with room at either end */
    double width;       /* mm */
    bool falling;       /* smaller values are harder: most borders hold above and fail below */
    char label[STABILITY_TEXT_SIZE];
} BorderAxis;

/* Room at either end, for what holds over the whole range or never. */
#define BORDER_AXIS_ROOM 4.4 /* mm */

/* The axis for the study that the row `first` is of. */
BorderAxis border_axis(const BorderTable *table, int first, double width);

/* mm */
double border_axis_place(const BorderAxis *axis, double value);

/* Writes the axis of the open panel. */
void border_axis_put(const BorderAxis *axis, GnuplotPage *page);
