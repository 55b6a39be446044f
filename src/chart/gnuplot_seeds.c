/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/gnuplot_seeds.h"

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

void gnuplot_seed_lines(GnuplotPage *page, SeedPoint *points, int count, const GnuplotLook *look) {
    GnuplotLook thin = gnuplot_look_thin(*look);
    qsort(points, (size_t)count, sizeof *points, by_seed);
    gnuplot_series_begin(page);
    for (int i = 0; i < count; i++) {
        if (i > 0 && points[i].seed != points[i - 1].seed) gnuplot_gap(page);
        gnuplot_point(page, points[i].x, points[i].y);
    }
    gnuplot_series_end(page, &thin);
}

void gnuplot_seed_median(GnuplotPage *page, SeedPoint *points, int count, const GnuplotLook *look) {
    qsort(points, (size_t)count, sizeof *points, by_value);
    gnuplot_series_begin(page);
    for (int i = 0, end; i < count; i = end) {
        for (end = i; end < count && points[end].x == points[i].x;) end++;
        gnuplot_point(page, points[i].x, (points[(i + end - 1) / 2].y + points[(i + end) / 2].y) / 2);
    }
    gnuplot_series_end(page, look);
}
