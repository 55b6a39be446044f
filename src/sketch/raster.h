/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Areas as pixels: which share of each pixel lies inside, by whole scan lines. Pixels, y down.
   Why our own: sketch_formats.h. */
#pragma once
#include "image/image.h"

#include <stdbool.h>

typedef struct RasterEdge {
    double x0, y0, x1, y1; /* y0 < y1 */
    int winding;           /* 1 or -1 */
} RasterEdge;

/* Zero it to begin with. */
typedef struct Raster {
    RasterEdge *edges;
    size_t count, capacity;
    bool failed; /* memory was short */
} Raster;

void raster_free(Raster *raster);

/* A side of an area. */
void raster_edge(Raster *raster, double x0, double y0, double x1, double y1);

/* Colours (0xRRGGBB) what the edges wind around, and forgets them. */
void raster_fill(Raster *raster, uint32_t colour, double opacity, Image *page);

/* One colour (of alpha 0 .. 255) over a pixel. */
void pixel_over(uint8_t *pixel, const uint8_t colour[3], int alpha);
