/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a panel of the figure of borders shows: bars over what holds, tiles at what fails, arrows and crosses. */
#pragma once
#include "stability/border_axis.h"

/* The rows of a study's panel: a method each, the first at the top, 1 apart on the panel's upward axis from 0. */
typedef struct BorderRows {
    const BorderTable *table;
    FigurePage *page;
    const BorderRow *study; /* any row of it */
    const BorderAxis *axis;
    const int *methods; /* [method_count]: a row of the table each */
    int method_count;
    double height; /* mm: of a row */
} BorderRows;

/* Upon the open panel. */
void border_marks_put(const BorderRows *rows);

/* What the legend explains: holds, holds throughout, never holds. A sample `width` mm wide on a panel in mm. */
enum { BORDER_SIGNS = 3 };
void border_sample_put(FigurePage *page, int sign, double x, double y, double width);
