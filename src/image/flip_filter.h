/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The separable filters of FLIP. */
#pragma once
#include "common/error.h"

enum { FLIP_RADIUS_MAX = 256 };

/* Values [height, width]. */
typedef struct FlipPlane {
    int width, height;
    float *values;
} FlipPlane;

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
typedef enum FlipChannel { FLIP_LIGHTNESS, FLIP_RED_GREEN, FLIP_BLUE_YELLOW } FlipChannel;
void flip_make_blur(FlipBlur *blur, FlipChannel channel, double pixels_per_degree);

/* Edge and point detectors (section 4.2.1): first and second derivative of a Gaussian, with the Gaussian across. */
typedef struct FlipFeatures {
    FlipKernel across, edge, point;
} FlipFeatures;
void flip_make_features(FlipFeatures *features, double pixels_per_degree);

/* to = from, filtered along rows by `x` and along columns by `y`; borders are replicated. scratch has the same size;
   padded[width + 2 * FLIP_RADIUS_MAX]. */
void flip_filter(const FlipPlane *from, const FlipKernel *x, const FlipKernel *y, FlipPlane *scratch, float *padded,
                 FlipPlane *to);
