/* SPDX-License-Identifier: GPL-3.0-or-later */
/* FLIP of a part of two pictures. */
#pragma once
#include "image/flip_color.h"
#include "image/flip_filter.h"
#include "image/image.h"

/* Half-open. */
typedef struct FlipArea {
    int left, top, right, bottom;
} FlipArea;

/* What depends only on the viewing distance. */
typedef struct FlipModel {
    FlipBlur blurs[FLIP_CHANNELS];
    FlipFeatures features;
    int reach;     /* largest radius of a filter */
    float largest; /* flip_largest_error() */
    float linear_of[256];
} FlipModel;
void flip_make_model(FlipModel *model, double pixels_per_degree);

enum { FLIP_TILE_WIDTH = 128, FLIP_TILE_HEIGHT = 64 };

/* Room for the filters of one tile. */
typedef struct FlipTile FlipTile;
FlipTile *flip_tile_create(const FlipModel *model, Error *error);
void flip_tile_destroy(FlipTile *tile);

/* values[y - area.top][x] = FLIP of pixel x, y of the area, which has at most the size of a tile, where it is larger
   than the value already there. Rows of `values` are `stride` apart. Beyond the pictures' edges, their outermost
   pixels continue. Where a pixel that counts is not opaque, the larger value on white and on black. */
void flip_tile_compute(FlipTile *tile, const Image *const pictures[2], FlipArea area, float *values, size_t stride);
