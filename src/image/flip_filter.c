/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/flip_filter.h"

#include <math.h>

#define PI 3.14159265358979323846

static int at_most(double radius) { return radius < FLIP_RADIUS_MAX ? (int)radius : FLIP_RADIUS_MAX; }

/* The constants of equation 3: weights and widths of up to two Gaussians. */
static const struct {
    double weight[2], width[2];
} sensitivity[] = {{{1, 0}, {0.0047, 0}}, {{1, 0}, {0.0053, 0}}, {{34.1, 13.5}, {0.04, 0.025}}};

void flip_make_blur(FlipBlur *blur, FlipChannel channel, double pixels_per_degree) {
    double volume[2] = {0, 0};
    /* One radius for all channels: three standard deviations of the widest Gaussian. */
    int radius = at_most(ceil(3 * sqrt(0.04 / (2 * PI * PI)) * pixels_per_degree));
    blur->count = sensitivity[channel].weight[1] > 0 ? 2 : 1;
    for (int i = 0; i < blur->count; i++) {
        FlipKernel *kernel = &blur->kernels[i];
        double sum = 0, width = sensitivity[channel].width[i];
        kernel->radius = radius;
        for (int k = -radius; k <= radius; k++) sum += exp(-PI * PI / width * pow(k / pixels_per_degree, 2));
        for (int k = -radius; k <= radius; k++)
            kernel->weights[k + radius] = (float)(exp(-PI * PI / width * pow(k / pixels_per_degree, 2)) / sum);
        volume[i] = sensitivity[channel].weight[i] * sqrt(PI / width) * sum * sum;
    }
    for (int i = 0; i < blur->count; i++) blur->share[i] = (float)(volume[i] / (volume[0] + volume[1]));
}

/* Scales the positive weights to a sum of 1, the negative ones to -1. */
static void normalise(FlipKernel *kernel, const double *weights) {
    double above = 0, below = 0;
    int count = 2 * kernel->radius + 1;
    for (int i = 0; i < count; i++) *(weights[i] > 0 ? &above : &below) += weights[i];
    for (int i = 0; i < count; i++) kernel->weights[i] = (float)(weights[i] / (weights[i] > 0 ? above : -below));
}

void flip_make_features(FlipFeatures *features, double pixels_per_degree) {
    enum { LARGEST = 2 * FLIP_RADIUS_MAX + 1 };
    double deviation = 0.5 * 0.082 * pixels_per_degree; /* 0.082 degrees: the feature width at the eye's peak
                                                           contrast sensitivity */
    int radius = at_most(ceil(3 * deviation));
    double across[LARGEST] = {0}, edge[LARGEST] = {0}, point[LARGEST] = {0};
    for (int k = -radius; k <= radius; k++) {
        double gaussian = exp(-k * k / (2 * deviation * deviation));
        across[k + radius] = gaussian;
        edge[k + radius] = -k * gaussian;
        point[k + radius] = (k * k / (deviation * deviation) - 1) * gaussian;
    }
    features->across.radius = features->edge.radius = features->point.radius = radius;
    normalise(&features->across, across);
    normalise(&features->edge, edge);
    normalise(&features->point, point);
}

void flip_filter(const float *from, const FlipKernel *kernel, size_t step, size_t stride, int width, int height,
                 float *to) {
#ifdef TWINBOX_AVX
    if (__builtin_cpu_supports("avx2")) {
        flip_filter_avx2(from, kernel, step, stride, width, height, to);
        return;
    }
#endif
    flip_filter_baseline(from, kernel, step, stride, width, height, to);
}
