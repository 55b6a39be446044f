/* SPDX-License-Identifier: GPL-3.0-or-later */
/* FLIP, the difference seen when two pictures alternate: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem,
   Fairchild, "FLIP: A Difference Evaluator for Alternating Images", HPG 2020 (doi:10.1145/3406183), the version for
   8-bit pictures.
   Colours are blurred with the eye's contrast sensitivity at the viewing distance and compared in a perceptually
   uniform space. Differences of edges and points amplify the result. */
#pragma once
#include "image/image.h"

/* Pixels per degree of a screen of 0.7 m and 3840 pixels seen from 0.7 m, as in the paper. */
#define FLIP_PIXELS_PER_DEGREE 67.02064327658225

typedef struct FlipSummary {
    double mean; /* over all pixels, 0 (equal) to 1 */
    double p99;  /* the least value that at least 99% of the pixels do not exceed */
} FlipSummary;

/* Receives the values[width] of every row, from the top. False with error set stops. */
typedef struct FlipSink {
    bool (*row)(void *context, const float *values, int width, Error *error);
    void *context;
} FlipSink;

/* Compares two pictures of equal size. If a pixel near a difference is not opaque, they are compared on white and on
   black, and the larger value of each pixel counts: transparent white is not opaque white. `sink` may be NULL. Only the
   neighbourhood of differences is computed, in tiles, so it takes little memory beside the pictures. False with error
   set if out of memory. */
bool flip_compare(const Image *expected, const Image *actual, double pixels_per_degree, const FlipSink *sink,
                  FlipSummary *result, Error *error);
