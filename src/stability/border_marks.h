/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The marks in a panel of the borders figure: bars where a method holds, tiles where it fails, arrows and crosses. */
#pragma once
#include "stability/border_axis.h"

/* The rows of a study's panel, one per method, from the top. */
typedef struct BorderRows {
    const BorderTable *table;
    Sketch *sketch;
    const BorderRow *study; /* any row of the study */
    const PlotPanel *panel; /* placed */
    bool falling;           /* as of BorderAxis */
    const int *methods;     /* [method_count]: a table row of each method */
    int method_count;
} BorderRows;

void border_marks_draw(const BorderRows *rows);

/* Draws the legend's sample of a sign (0: holds, 1: holds throughout, 2: never holds), `width` mm wide from `left`. */
enum { BORDER_SIGNS = 3 };
void border_sample_draw(Sketch *sketch, int sign, Point left, double width);
