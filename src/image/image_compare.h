/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Comparison of two pictures, pixel by pixel. */
#pragma once
#include "image/image.h"

/* If the sizes differ, only same_size is set. */
typedef struct ImageDifference {
    bool equal, same_size;
    int64_t pixels;               /* differing and not ignored */
    int64_t beyond;               /* of these, those that differ by more than the tolerance */
    int64_t moved;                /* differing, but ignored as parts of an edge that moved (IGNORED_EDGE) */
    int64_t counted;              /* not masked */
    int largest;                  /* largest difference of a channel, 0..255, rounded up */
    int first_x, first_y;         /* first differing pixel, row by row; -1, -1 if none */
    int left, top, right, bottom; /* bounds of the differences; right and bottom are exclusive */
} ImageDifference;
void image_compare(const Image *a, const Image *b, ImageDifference *difference);

/* The largest difference of a channel of one pixel, as above. Both pictures must have the same size. */
int image_pixel_difference(const Image *a, const Image *b, size_t pixel);

/* The next pixel from x on that may differ, in the row that begins at pixel `first`; `width` if there is none. Certain
   where both pictures have 8 bits. */
size_t image_next_difference(const Image *a, const Image *b, size_t first, size_t x);

/* masked[height, width]: see image/mask.h; NULL: nothing is ignored. tolerance: 0..255. */
void image_compare_masked(const Image *a, const Image *b, const uint8_t *masked, int tolerance,
                          ImageDifference *difference);

/* Cuts both pictures to their overlap: what both have when their top left corners meet. */
void image_cut_to_overlap(Image *a, Image *b);
