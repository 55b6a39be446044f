/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The separable filters of FLIP. */
#pragma once
#include <stddef.h>

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
