/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finds pixels that differ only because an edge was rasterised otherwise: with other samples, or moved by a part of a
   pixel.

   Start: V. Vysniauskas, "Anti-aliased Pixel and Intensity Slope Detector", Elektronika ir Elektrotechnika 7(95), 2009,
   pp. 107-110, in the form of pixelmatch and odiff: a pixel is anti-aliased if it lies between its darkest and its
   brightest neighbour, and one of these has three equal neighbours in both pictures. This fails in two ways. The middle
   of a thin line or ring is darker than all its neighbours, so it counts as different as soon as the line moves. And
   nothing bounds the colour in the other picture: a wrong pixel at an edge passes.

   Here the change itself is bounded. In windows of 3 x 3 pixels, for each channel (premultiplied by alpha), with the
   contrast c of both windows together:

   1. The pixel changes by at most 0.6 c: its coverage by the shape changes by at most 0.6. Half a pixel is what separates
      a sampled from an exact edge; an edge that moves by a whole pixel is a difference. In one channel c is at least 16
      of 255: gradients of areas are no edges.
   2. Either each value lies within the range of the other window: an edge between two colours that both pictures show.
      Or the sums of both windows differ by at most 3 * 0.15 c: a thin line has moved, and has kept its strength.
   3. Within two pixels there is a flat colour (three neighbours are equal to it) that both pictures share: one side of
      the edge. In textures, such as photos, nothing is an edge.

   Values within 2 + c / 16 of each other count as equal.

   Fails: a line of less than two pixels that fades by less than 15% looks like a line that became narrower, and passes; so
   does a faint mark along an edge of higher contrast. Rings less than two pixels apart have no flat side and count. */
#pragma once
#include "image/image.h"

/* Sets masked[height, width] (image/mask.h) to IGNORED_EDGE where pixels differ in this way and are not ignored yet.
   Both pictures must have the same size. Compares 8 bits per channel. */
void antialias_mark(const Image *expected, const Image *actual, uint8_t *masked);
