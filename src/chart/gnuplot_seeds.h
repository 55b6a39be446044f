/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Series of a measurement that was repeated with several seeds. */
#pragma once
#include "chart/gnuplot_page.h"

typedef struct SeedPoint {
    double seed, x, y; /* never NaN */
} SeedPoint;

/* Draws a thin line per seed. Sorts the points. */
void gnuplot_seed_lines(GnuplotPage *page, SeedPoint *points, int count, const GnuplotLook *look);

/* Draws the median over the seeds at each x. Sorts the points. */
void gnuplot_seed_median(GnuplotPage *page, SeedPoint *points, int count, const GnuplotLook *look);
