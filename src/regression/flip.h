/* SPDX-License-Identifier: GPL-3.0-or-later */
/* FLIP, a measure of the difference that is seen; and its parts. */
#pragma once
#include "base/base.h"
#include "pixels/png.h"

#include <stddef.h>
#include <stdint.h>

/* FLIP, the difference seen when two pictures alternate: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem,
   Fairchild, "FLIP: A Difference Evaluator for Alternating Images", HPG 2020 (doi:10.1145/3406183), the version for
   8-bit pictures.
   Colours are blurred with the eye's contrast sensitivity at the viewing distance and compared in a perceptually
   uniform space. Differences of edges and points amplify the result. */

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

/* The separable filters. */

enum { FLIP_RADIUS_MAX = 256 };

/* Weights of pixels -radius .. radius. */
typedef struct FlipKernel {
    int radius;
    float weights[2 * FLIP_RADIUS_MAX + 1];
} FlipKernel;

/* Contrast sensitivity of a channel (section 4.1.1): at most two Gaussians, whose shares sum to 1. */
typedef struct FlipBlur {
    int count;
    float share[2];
    FlipKernel kernels[2];
} FlipBlur;
typedef enum FlipChannel { FLIP_LIGHTNESS, FLIP_RED_GREEN, FLIP_BLUE_YELLOW, FLIP_CHANNELS } FlipChannel;
void flip_make_blur(FlipBlur *blur, FlipChannel channel, double pixels_per_degree);

/* Edge and point detectors (section 4.2.1): first and second derivative of a Gaussian, with the Gaussian across. */
typedef struct FlipFeatures {
    FlipKernel across, edge, point;
} FlipFeatures;
void flip_make_features(FlipFeatures *features, double pixels_per_degree);

/* Values are filtered in blocks: `width` is a multiple of this. */
enum { FLIP_BLOCK = 64 };

/* to[height, width] = the sums over k of weights[k] * from[k * step], in ascending order of k, which fixes the bits.
   `from` is where weight 0 of the first value applies; its rows, and those of `to`, are `stride` apart. step 1 filters
   along rows, `stride` along columns. */
void flip_filter(const float *from, const FlipKernel *kernel, size_t step, size_t stride, int width, int height,
                 float *to);

/* The same for one instruction set; flip_filter() takes the widest that the processor has. */
void flip_filter_baseline(const float *from, const FlipKernel *kernel, size_t step, size_t stride, int width,
                          int height, float *to);
void flip_filter_avx2(const float *from, const FlipKernel *kernel, size_t step, size_t stride, int width, int height,
                      float *to);

/* The colours. Constants and equation numbers are the paper's. */

typedef struct FlipColor {
    float x, y, z; /* in any colour space */
} FlipColor;

/* linear_of[byte]: sRGB made linear, 0 to 1. */
void flip_make_linear(float linear_of[256]);

typedef enum FlipBackground { FLIP_WHITE, FLIP_BLACK } FlipBackground;

/* RGBA pixels on a background in a linear opponent space, in which lightness and the two chroma channels are blurred
   separately (section 4.1.1): lightness[count], red_green[count], blue_yellow[count]. */
void flip_load_row(const uint8_t *pixels, int count, FlipBackground background, const float linear_of[256],
                   float *lightness, float *red_green, float *blue_yellow);

/* From the opponent space to CIELab with the Hunt effect: less chroma at low lightness (section 4.1.2). */
FlipColor flip_hunt_lab(FlipColor opponent);

/* The distance between green and blue, the largest of all, raised as in flip_color_error(). */
float flip_largest_error(void);

/* 0 to 1, for two colours in CIELab (section 4.1.3); errors above a knee are compressed. */
float flip_color_error(FlipColor a, FlipColor b, float largest);

/* Equation 6: `color` amplified by the difference of edges or points, `feature`. */
float flip_amplify(float color, float feature);

/* The largest of many values that come one after another, for an exact percentile in little memory. */

typedef struct Largest {
    size_t keep;  /* how many of the largest values matter */
    size_t count; /* of `values`; at most 2 * keep */
    float least;  /* values that are not larger need not be kept */
    float *values;
} Largest;

bool largest_create(Largest *largest, size_t keep, Error *error);
void largest_free(Largest *largest);

/* Adds a value from 0. */
void largest_add(Largest *largest, float value);

/* The least of the `keep` largest values; 0 if fewer were added. */
float largest_least(Largest *largest);
