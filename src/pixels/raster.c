/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact coverage, by signed areas: each piece of a side within a pixel adds the area between it and the pixel's right
   side, and its height to all pixels farther right. */
#include "pixels/raster.h"

#include "base/base.h"

#include <math.h>
#include <stdlib.h>

void raster_free(Raster *raster) {
    free(raster->ends);
    *raster = (Raster){0};
}

void raster_add(Raster *raster, Point from, Point to) {
    const size_t i = 2 * raster->count;
    if (!array_reserve((void **)&raster->ends, &raster->capacity, i + 2, sizeof *raster->ends)) {
        raster->failed = true;
        return;
    }
    if (i == 0) raster->x0 = raster->y0 = HUGE_VAL, raster->x1 = raster->y1 = -HUGE_VAL;
    raster->x0 = fmin(raster->x0, fmin(from.x, to.x)), raster->x1 = fmax(raster->x1, fmax(from.x, to.x));
    raster->y0 = fmin(raster->y0, fmin(from.y, to.y)), raster->y1 = fmax(raster->y1, fmax(from.y, to.y));
    raster->ends[i] = from, raster->ends[i + 1] = to;
    raster->count++;
}

/* The part of a side within a row, from left to right; `rise` has the sign of its direction. */
static void add_in_row(double *areas, double x0, double x1, double rise) {
    for (int x = (int)x0; x0 < x1 || x == (int)x0; x++) {
        const double end = fmin(x + 1, x1), share = x1 > x0 ? (end - x0) / (x1 - x0) : 1, part = rise * share;
        const double right = (x0 + end) / 2 - x;
        areas[x] += part * (1 - right);
        areas[x + 1] += part * right;
        rise -= part;
        x0 = end;
        if (x0 >= x1) return;
    }
}

/* areas: [height, width + 2] */
static void add_side(double *areas, int width, int height, Point from, Point to) {
    const double sign = from.y < to.y ? 1 : -1;
    const Point high = sign > 0 ? from : to, low = sign > 0 ? to : from;
    if (from.y == to.y) return;
    const double slope = (low.x - high.x) / (low.y - high.y);
    for (int row = (int)fmax(high.y, 0); row < height && row < low.y; row++) {
        const double y0 = fmax(row, high.y), y1 = fmin(row + 1, low.y);
        const double a = high.x + slope * (y0 - high.y), b = high.x + slope * (y1 - high.y);
        const double x0 = fmin(fmax(fmin(a, b), 0), width), x1 = fmin(fmax(fmax(a, b), 0), width);
        add_in_row(areas + (size_t)row * (size_t)(width + 2), x0, x1, sign * (y1 - y0));
    }
}

void raster_fill(Raster *raster, const Rect *clip, RasterRow *put, void *context) {
    const size_t count = raster->count;
    raster->count = 0;
    if (count == 0 || raster->failed) return;
    const int left = (int)fmax(floor(fmin(raster->x0, clip->right)), clip->left),
              top = (int)fmax(floor(fmin(raster->y0, clip->bottom)), clip->top),
              width = (int)fmin(ceil(fmax(raster->x1, clip->left)), clip->right) - left,
              height = (int)fmin(ceil(fmax(raster->y1, clip->top)), clip->bottom) - top;
    if (width <= 0 || height <= 0) return;
    double *areas = calloc((size_t)height * (size_t)(width + 2), sizeof *areas);
    raster->failed = areas == NULL;
    for (size_t i = 0; i < count && areas != NULL; i++) {
        const Point *from = &raster->ends[2 * i], *to = from + 1;
        add_side(areas, width, height, (Point){from->x - left, from->y - top}, (Point){to->x - left, to->y - top});
    }
    for (int y = 0; y < height && areas != NULL; y++) {
        double *row = areas + (size_t)y * (size_t)(width + 2), area = 0;
        for (int x = 0; x < width; x++) {
            area += row[x];
            row[x] = fmin(fabs(area), 1);
        }
        put(context, left, top + y, row, width);
    }
    free(areas);
}
