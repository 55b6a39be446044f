/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A measurement that was repeated with several seeds. */
#pragma once
#include "chart/figure_page.h"

typedef struct SeedPoint {
    double seed, x, y; /* no NAN */
} SeedPoint;

/* A thin line for each seed. Sorts the points. */
void figure_seed_lines(FigurePage *page, SeedPoint *points, int count, const FigureLook *look);

/* The median over the seeds, at each x. Sorts the points. */
void figure_seed_median(FigurePage *page, SeedPoint *points, int count, const FigureLook *look);
