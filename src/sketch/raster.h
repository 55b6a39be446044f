/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A polygon rasteriser with antialiasing by scan-line coverage. Pixels, y down.
   Why our own: sketch_formats.h. */
#pragma once
#include "image/image.h"

#include <stdbool.h>

typedef struct RasterEdge {
    double x0, y0, x1, y1; /* y0 < y1 */
    int winding;           /* 1 or -1 */
} RasterEdge;

/* Initialise with zeros. */
typedef struct Raster {
    RasterEdge *edges;
    size_t count, capacity;
    bool failed; /* out of memory */
} Raster;

void raster_free(Raster *raster);

/* Adds a side of a polygon. */
void raster_edge(Raster *raster, double x0, double y0, double x1, double y1);

/* Fills the interior of the edges (nonzero winding) with a colour, 0xRRGGBB, and removes the edges. */
void raster_fill(Raster *raster, uint32_t colour, double opacity, Image *page);

/* Blends one colour, alpha 0 .. 255, over a pixel. */
void pixel_over(uint8_t *pixel, const uint8_t colour[3], int alpha);
