/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two pictures pixel by pixel, and the regions in which they differ:

     image_compare_masked(a, b, NULL, 0, &difference);
     image_regions_find(a, b, NULL, &difference, &regions, error);

   Pictures that are read row by row give the same to a RowCompare. */
#pragma once
#include "base/base.h"
#include "pixels/png.h"
#include "regression/antialias.h"

#include <stdint.h>

/* If the sizes differ, only same_size is set. */
typedef struct ImageDifference {
    bool equal, same_size;
    int64_t pixels;               /* differing and not ignored */
    int64_t beyond;               /* of these, those that differ by more than the tolerance */
    int64_t moved;                /* differing, but ignored: IGNORED_EDGE */
    int64_t counted;              /* not masked */
    int largest;                  /* largest difference of a channel, 0..255, rounded up */
    int first_x, first_y;         /* first differing pixel, row by row; -1, -1 if none */
    int left, top, right, bottom; /* bounds of the differences; right and bottom are exclusive */
} ImageDifference;

/* masked[height, width]: Ignored; NULL: nothing is ignored. tolerance: 0..255. */
void image_compare_masked(const Image *a, const Image *b, const uint8_t *masked, int tolerance,
                          ImageDifference *difference);

/* The largest difference of a channel of one pixel, 0..255, rounded up: 16 bits count where pictures have them. Both
   pictures must have the same size. */
int image_pixel_difference(const Image *a, const Image *b, size_t pixel);

/* levels[count]: the largest difference of a channel of each pixel from `first` on, 0 where masked. Returns how many
   differ, but are ignored and not masked. */
int64_t image_find_levels(const Image *a, const Image *b, const uint8_t *masked, size_t first, size_t count,
                          uint8_t *levels);

/* Cuts both pictures to their overlap: what both have when their top left corners meet. */
void image_cut_to_overlap(Image *a, Image *b);

/* Clusters of differing pixels. Two differing pixels belong to one region if a chain of differing pixels links them
   whose steps are at most the gap, in x and in y: the space between two words of a caption, REGION_GAP pixels or, in
   large pictures, up to three times as many. So a moved box is one or two regions, and so is a caption. Time is
   linear in the pixels and memory in the width, whatever the pictures show. */

enum { IMAGE_REGIONS_MAX = 16, REGION_GAP = 4 };

/* Where fewer than half of the first pixels that differ do so as edges may, edges are not looked for, and cost
   nothing. */
enum { EDGES_SAMPLE = 1024 };

typedef struct ImageRegion {
    int64_t pixels;               /* differing */
    int64_t edges;                /* of these, those that differ as pixels along edges may (antialias.h) */
    int left, top, right, bottom; /* bounds; right and bottom are exclusive */
    int largest;                  /* difference */
} ImageRegion;

typedef struct ImageRegions {
    int64_t count; /* of all regions */
    int64_t edges; /* pixels along edges of all regions */
    int kept;
    ImageRegion list[IMAGE_REGIONS_MAX]; /* [kept], the largest: most pixels first, then by top, then by left */
} ImageRegions;

/* `difference` is what image_compare_masked() found in the same pictures and mask. False with error set if out of
   memory. */
bool image_regions_find(const Image *a, const Image *b, const uint8_t *masked, const ImageDifference *difference,
                        ImageRegions *regions, Error *error);

/* The same for pictures of at most 8 bits that are read from the top. Each row that differs, and those ROWS_AROUND
   rows above and below it, must be placed and given; others may be left out:

     row_compare_begin(&compare, width, height, tolerance, NULL);
     memcpy(edge_rows_place(&compare.sides[side], y), pixels, 4 * width);
     row_compare_row(&compare, y, differs);
     row_compare_end(&compare);                                       ... difference, regions */

enum { ROWS_AROUND = EDGE_REACH };

typedef struct RegionScan RegionScan;
typedef struct RowCompare {
    ImageDifference difference;
    ImageRegions regions;
    int width, height, tolerance;
    EdgeRows sides[2];
    int pending;         /* the first row that may wait for those below it */
    uint8_t *levels;     /* [EDGE_ROWS, width], by number modulo EDGE_ROWS */
    uint8_t *all_levels; /* [height, width], or NULL */
    bool differs[EDGE_ROWS];
    RegionScan *scan; /* from the first row that differs */
    Error error;
} RowCompare;

/* all_levels[height, width] of zeros gets the levels of rows that differ; NULL: they are not kept. False with `error`
   of the comparison set if out of memory, then or later. row_compare_free() must follow. */
bool row_compare_begin(RowCompare *compare, int width, int height, int tolerance, uint8_t *all_levels);
void row_compare_row(RowCompare *compare, int y, bool differs); /* where it does not, only side 0 is placed */
bool row_compare_end(RowCompare *compare);
void row_compare_free(RowCompare *compare);
