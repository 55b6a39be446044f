/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Exact coverage of pixels by polygons, for glyphs and for figures.

       Raster raster = {0};
       raster_add(&raster, a, b), raster_add(&raster, b, c), raster_add(&raster, c, a);
       raster_fill(&raster, page, put_row, context);
       raster_free(&raster); */
#pragma once
#include "pixels/gl.h"
#include "pixels/png.h"

#include <stdbool.h>
#include <stddef.h>

/* The sides of closed polygons, in pixels, y down, in any order. Polygons of one direction that overlap stay filled.
   Initialise with zeros. */
typedef struct Raster {
    Point *ends; /* [2 * count] */
    size_t count, capacity;
    double x0, y0, x1, y1; /* bounds */
    bool failed;           /* out of memory */
} Raster;

void raster_free(Raster *raster);
void raster_add(Raster *raster, Point from, Point to);

/* Row y from pixel x on: the shares that are covered, 0 to 1. */
typedef void RasterRow(void *context, int x, int y, const double *shares, int count);

/* Gives the rows inside `clip` to `put`, and removes the sides. */
void raster_fill(Raster *raster, const Rect *clip, RasterRow *put, void *context);
