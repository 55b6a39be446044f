/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/figure_seeds.h"

#include <stdlib.h>

static int compare(double a, double b) { return (a > b) - (a < b); }

static int by_seed(const void *first, const void *second) {
    const SeedPoint *a = first, *b = second;
    int order = compare(a->seed, b->seed);
    if (order == 0) order = compare(a->x, b->x);
    return order != 0 ? order : compare(a->y, b->y);
}

static int by_value(const void *first, const void *second) {
    const SeedPoint *a = first, *b = second;
    int order = compare(a->x, b->x);
    return order != 0 ? order : compare(a->y, b->y);
}

void figure_seed_lines(FigurePage *page, SeedPoint *points, int count, const FigureLook *look) {
    FigureLook thin = figure_thin(*look);
    qsort(points, (size_t)count, sizeof *points, by_seed);
    figure_series(page);
    for (int i = 0; i < count; i++) {
        if (i > 0 && points[i].seed != points[i - 1].seed) figure_gap(page);
        figure_point(page, points[i].x, points[i].y);
    }
    figure_draw(page, &thin);
}

void figure_seed_median(FigurePage *page, SeedPoint *points, int count, const FigureLook *look) {
    qsort(points, (size_t)count, sizeof *points, by_value);
    figure_series(page);
    for (int i = 0, end; i < count; i = end) {
        for (end = i; end < count && points[end].x == points[i].x;) end++;
        figure_point(page, points[i].x, (points[(i + end - 1) / 2].y + points[(i + end) / 2].y) / 2);
    }
    figure_draw(page, look);
}
