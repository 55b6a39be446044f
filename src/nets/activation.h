/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sigmoid, tanh, ReLU and e^y in a fixed sequence of operations, so that the bits do not depend on maths library,
   compiler or instruction set, and without calls or branches, so that the compiler vectorises loops over them.

   float32 for inference: within 3 units in the last place of a normal result (a sigmoid below 2^-127 is 0). In double a
   correctly rounded activation would cost more than the rest of a network. double for training: within 4e-16 of the
   result.

   e^y = 2^k e^r with k the integer nearest to y / ln 2: ln 2 is subtracted in two parts, the first short enough for its
   multiples to be exact (Cody and Waite, "Software Manual for the Elementary Functions", 1980). The polynomial is e^r =
   1 + r + r^2 g(r), g interpolated at the Chebyshev nodes of |r| <= ln 2 / 2; its error is 1.0e-8 in float32, 1.7e-17
   in double. Adding 1.5 * 2^23 (2^52 in double) rounds to an integer and leaves it in the low bits of the sum. */
#pragma once
#include <math.h>
#include <stdint.h>
#include <string.h>

/* Returns e^r - 1, and 2^k in *power; y in [-87, 88.8], where k = 128 gives infinity; NaN stays NaN. */
static inline float exp_parts_float(float y, float *power) {
    const float shift = 0x1.8p23f + 127; /* 127: the bias of the exponent */
    float sum = y * 0x1.715476p0f + shift, k = sum - shift;
    float r = (y - k * 0x1.62e4p-1f) - k * 0x1.7f7d1cp-20f;
    uint32_t bits;
    memcpy(&bits, &sum, sizeof bits);
    bits <<= 23;
    memcpy(power, &bits, sizeof bits);
    float r2 = r * r;
    float g = (0.5f + 0x1.5554dcp-3f * r) + r2 * ((0x1.555518p-5f + 0x1.120be2p-7f * r) + r2 * 0x1.6d117cp-10f);
    return r + r2 * g;
}

/* The same for y in [-700, 700]. */
static inline double exp_parts(double y, double *power) {
    const double shift = 0x1.8p52 + 1023;
    double sum = y * 0x1.71547652b82fep0 + shift, k = sum - shift;
    double r = (y - k * 0x1.62e42fefa2000p-1) - k * 0x1.9ef35793c7673p-41;
    uint64_t bits;
    memcpy(&bits, &sum, sizeof bits);
    bits <<= 52;
    memcpy(power, &bits, sizeof bits);
    double r2 = r * r, r4 = r2 * r2;
    double g0 = (0.5 + 0x1.5555555555556p-3 * r) + r2 * (0x1.5555555553d37p-5 + 0x1.11111111109a6p-7 * r);
    double g4 =
        (0x1.6c16c1789d1d7p-10 + 0x1.a01a01a7cebcdp-13 * r) + r2 * (0x1.a019b8ca26fcfp-16 + 0x1.71de0d85293b8p-19 * r);
    double g8 = 0x1.2891d4ffbb0f9p-22 + 0x1.af390ba7e6f47p-26 * r;
    return r + r2 * (g0 + r4 * (g4 + r4 * g8));
}

/* e^y for y in [-700, 700], within 1.25 units in the last place; NaN stays NaN. */
static inline double exponential(double y) {
    double power, q = exp_parts(y, &power);
    return power * (1.0 + q);
}

/* Comparisons are written so that NaN propagates. */
static inline float sigmoid_float(float x) {
    float y = -x > 88.8f ? 88.8f : -x, power, q = exp_parts_float(y, &power), e = power * (1.0f + q);
    return 1.0f / (1.0f + (x > 87.0f ? 0.0f : e)); /* e^-87 is negligible beside 1 */
}

static inline double sigmoid(double x) {
    double e = exponential(-x > 700.0 ? 700.0 : -x);
    return 1.0 / (1.0 + (x > 700.0 ? 0.0 : e));
}

/* (e^y - 1) / (e^y + 1) with y = 2 |x|; e^y - 1 = 2^k (e^r - 1) + (2^k - 1) keeps full precision near 0. */
static inline float tanh_float(float x) {
    float y = 2.0f * fabsf(x), power;
    y = y > 20.0f ? 20.0f : y;
    float q = exp_parts_float(y, &power), e = power * q + (power - 1.0f);
    return copysignf(e / (e + 2.0f), x);
}

static inline double tangent(double x) {
    double y = 2.0 * fabs(x), power;
    y = y > 40.0 ? 40.0 : y;
    double q = exp_parts(y, &power), e = power * q + (power - 1.0);
    return copysign(e / (e + 2.0), x);
}

/* max(x, 0); NaN stays NaN, and -0 stays -0. */
static inline float relu_float(float x) { return x < 0.0f ? 0.0f : x; }

static inline double relu(double x) { return x < 0.0 ? 0.0 : x; }
