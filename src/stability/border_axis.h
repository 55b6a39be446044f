/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The axis of a study in the borders figure. */
#pragma once
#include "sketch/plot.h"
#include "stability/stability_table.h"

typedef struct BorderAxis {
    PlotAxis axis; /* over the study's values, widened if too narrow, with a margin at both ends */
    bool falling;  /* smaller values are harder: most methods hold above their border and fail below */
    char label[STABILITY_TEXT_SIZE];
} BorderAxis;

/* Margin at both ends for the marks of methods that hold over the whole range or never. */
#define BORDER_AXIS_ROOM 4.4 /* mm */

/* The axis of the study of row `first`, `width` mm long; its label is not set in `axis`. */
BorderAxis border_axis(const BorderTable *table, int first, double width);
