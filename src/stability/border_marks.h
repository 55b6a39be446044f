/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The marks in a panel of the borders figure: bars where a method holds, tiles where it fails, arrows and crosses. */
#pragma once
#include "stability/border_axis.h"

/* The rows of a study's panel, one per method. Row i is at y = method_count - 1 - i on the panel's axis. */
typedef struct BorderRows {
    const BorderTable *table;
    GnuplotPage *page;
    const BorderRow *study; /* any row of the study */
    const BorderAxis *axis;
    const int *methods; /* [method_count]: a table row of each method */
    int method_count;
    double height; /* mm per row */
} BorderRows;

/* Draws the marks on the open panel. */
void border_marks_draw(const BorderRows *rows);

/* Draws the legend's sample of a sign (0: holds, 1: holds throughout, 2: never holds), `width` mm wide, on a panel in
   mm. */
enum { BORDER_SIGNS = 3 };
void border_sample_draw(GnuplotPage *page, int sign, double x, double y, double width);
