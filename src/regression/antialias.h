/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pixels that differ only because an edge was rasterised otherwise: with other samples, or moved by a part of a pixel.

     uint8_t *masked = calloc(height, width);
     antialias_mark(expected, actual, masked, error);     ... IGNORED_EDGE in masked[y, x]

   Start: V. Vysniauskas, "Anti-aliased Pixel and Intensity Slope Detector", Elektronika ir Elektrotechnika 7(95), 2009,
   pp. 107-110, in the form of pixelmatch and odiff: a pixel is anti-aliased if it lies between its darkest and its
   brightest neighbour, and one of these has three equal neighbours in both pictures. This fails in two ways. The middle
   of a thin line or ring is darker than all its neighbours, so it counts as different as soon as the line moves. And
   nothing bounds the colour in the other picture: a wrong pixel at an edge passes.

   Here the change itself is bounded. In windows of 3 x 3 pixels, for each channel (premultiplied by alpha), with the
   contrast c of both windows together:

   1. The pixel changes by at most 0.6 c: its coverage by the shape changes by at most 0.6. Half a pixel is what
      separates a sampled from an exact edge; an edge that moves by a whole pixel is a difference. In one channel c is
      at least 16 of 255: gradients of areas are no edges.
   2. Either each value lies within the range of the other window: an edge between two colours that both pictures show.
      Or the sums of both windows differ by at most 3 * 0.15 c: a thin line has moved, and has kept its strength. Where
      it crosses another, the same holds of a window of 5 x 5 pixels around the pixel or one of its neighbours; and
      where it lies between two flat colours, the outline of a shape, after what it takes to move them by half a pixel
      at most.
   3. Within two pixels there is a flat colour (three neighbours are equal to it) that both pictures share: one side of
      the edge. In textures, such as photos, nothing is an edge.

   4. If the colours of each window, and of 5 x 5 pixels around the pixel, are mixtures of two, so are those of both
      windows together: a line of another colour has not moved. Beside a third colour, it is that which may have moved.

   Values within 2 + c / 16 of each other count as equal, in 4 within 2, of both windows together within 2.5. Exchanging
   the pictures changes nothing.

   Fails: a line of less than two pixels that fades by less than 15% towards the colour around it looks like a line that
   became narrower, and passes; so does a faint mark along an edge of higher contrast. Where lines cross at less than 20
   degrees, some pixels may count. Rings less than two pixels apart have no flat side and count. */
#pragma once
#include "base/base.h"
#include "pixels/png.h"

#include <stdint.h>

/* What a byte of masked[height, width] tells of its pixel. Pixels that are not IGNORED_NOT are ignored. */
typedef enum Ignored { IGNORED_NOT, IGNORED_MASK, IGNORED_EDGE } Ignored;

/* Sets masked[height, width] to IGNORED_EDGE where pixels differ in this way and are not ignored yet. Both pictures
   must have the same size. Compares 8 bits per channel. False with error set if out of memory. */
bool antialias_mark(const Image *expected, const Image *actual, uint8_t *masked, Error *error);

/* The same row by row. A row is judged when it and EDGE_REACH rows above and below it are known. */

enum { EDGE_REACH = 3, EDGE_ROWS = 2 * EDGE_REACH + 1 };

/* The rows of a picture around one, premultiplied by alpha; beyond its edges, the pixels at its edges. */
typedef struct EdgeRows {
    int width, height;
    uint8_t *memory;                /* EDGE_ROWS rows, by number modulo EDGE_ROWS */
    size_t stride;                  /* bytes: EDGE_REACH pixels, a row, EDGE_REACH pixels and room for a vector */
    int numbers[EDGE_ROWS];         /* of the rows in memory */
    const uint8_t *rows[EDGE_ROWS]; /* from y - EDGE_REACH on; [4 * x] is EDGE_REACH pixels left of pixel x */
} EdgeRows;

/* False if out of memory. `memory` is to be freed. */
bool edge_rows_create(EdgeRows *edges, int width, int height);

/* The place of row y as RGBA; once its pixels are there, edge_rows_add(). */
uint8_t *edge_rows_place(EdgeRows *edges, int y);
void edge_rows_add(EdgeRows *edges, int y);

/* Adds the rows of the picture around y that are not there. */
void edge_rows_load(EdgeRows *edges, const Image *image, int y);

/* Sets masked[width] to IGNORED_EDGE in row y. levels[width]: of its pixels, 0 where they are equal. */
void edge_rows_mark(EdgeRows *a, EdgeRows *b, int y, const uint8_t *levels, uint8_t *masked);

/* The same as image_find_levels(), for pixels in memory. */
void image_levels(const uint8_t *a, const uint8_t *b, size_t count, uint8_t *levels);
