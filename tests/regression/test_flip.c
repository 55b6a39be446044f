/* SPDX-License-Identifier: GPL-3.0-or-later */
/* FLIP in closed form where filters have no effect: uniform pictures differ only by colour. Elsewhere, laws. */
#include "made.h"

#include "regression/flip.h"

#include <math.h>

enum { SIDE = 64 };
static Image *a, *b;

FIXTURE(make) {
    a = image_sized(SIDE, SIDE);
    b = image_sized(SIDE, SIDE);
}

FIXTURE(destroy) {
    image_destroy(a);
    image_destroy(b);
}

static void paint(Image *image, int left, int right, uint32_t color) {
    for (int y = 0; y < image->height; y++)
        for (int x = left; x < right; x++) {
            uint8_t *p = image->pixels + (y * image->width + x) * 4;
            p[0] = (uint8_t)(color >> 16), p[1] = (uint8_t)(color >> 8), p[2] = (uint8_t)color, p[3] = 255;
        }
}

/* `map` points to where the next row goes. */
static bool keep_row(void *map, const float *values, int width, Error *error) {
    float **next = map;
    (void)error;
    memcpy(*next, values, (size_t)width * sizeof *values);
    *next += width;
    return true;
}

static double flip(float *map) {
    Error error = {0};
    FlipSummary result;
    float *next = map;
    const FlipSink sink = {keep_row, &next};
    assert_ok(flip_compare(a, b, FLIP_PIXELS_PER_DEGREE, map != NULL ? &sink : NULL, &result, &error), error);
    return result.mean;
}

static double flip_plain(uint32_t first, uint32_t second) {
    paint(a, 0, SIDE, first);
    paint(b, 0, SIDE, second);
    return flip(NULL);
}

/* For greys CIELab is only lightness, so the paper's equations are short. The largest distance, between green and
   blue, was computed independently in double precision. */
static double expected_grey(double first, double second) {
    const double largest = 41.27609828519836;
    double light[2], value[2] = {first / 255, second / 255};
    for (int i = 0; i < 2; i++) {
        double y = value[i] <= 0.04045 ? value[i] / 12.92 : pow((value[i] + 0.055) / 1.055, 2.4);
        light[i] = y > pow(6.0 / 29, 3) ? 116 * cbrt(y) - 16 : y * pow(29.0 / 3, 3);
    }
    double error = pow(fabs(light[0] - light[1]), 0.7), knee = 0.4 * largest;
    return error < knee ? 0.95 * error / knee : 0.95 + 0.05 * (error - knee) / (largest - knee);
}

TEST_WITH(equal_pictures_have_none, make, destroy) { assert_true(flip_plain(0x336699, 0x336699) == 0); }

TEST_WITH(plain_greys_follow_the_equations, make, destroy) {
    for (int grey = 0; grey < 256; grey += 5) {
        uint32_t color = (uint32_t)grey * 0x010101;
        assert_near(flip_plain(0xFFFFFF, color), expected_grey(255, grey), 1e-4);
        assert_near(flip_plain(color, 0x000000), expected_grey(grey, 0), 1e-4);
    }
    assert_near(flip_plain(0xFFFFFF, 0x000000), 0.967380, 1e-5);
}

/* The pair that the paper normalises with. */
TEST_WITH(green_and_blue_are_the_farthest, make, destroy) { assert_near(flip_plain(0x00FF00, 0x0000FF), 1, 1e-5); }

TEST_WITH(it_is_symmetric, make, destroy) {
    paint(a, 0, SIDE, 0xFFFFFF);
    paint(a, 20, 30, 0x0072B2);
    paint(b, 0, SIDE, 0xFFFFFF);
    paint(b, 24, 40, 0xB5371B);
    double there = flip(NULL);
    Image *swapped = a;
    a = b, b = swapped;
    assert_true(there > 0 && flip(NULL) == there);
}

TEST_WITH(a_larger_shift_looks_larger, make, destroy) {
    double before = 0;
    paint(a, 0, SIDE, 0xFFFFFF);
    paint(a, 10, 20, 0x0072B2);
    for (int shift = 1; shift < 8; shift++) {
        paint(b, 0, SIDE, 0xFFFFFF);
        paint(b, 10 + shift, 20 + shift, 0x0072B2);
        double now = flip(NULL);
        assert_true(now > before);
        before = now;
    }
}

/* At many pixels per degree, the eye blurs stripes to the grey of equal luminance. */
TEST_WITH(fine_stripes_vanish_with_distance, make, destroy) {
    FlipSummary near, far;
    for (int x = 0; x < SIDE; x++) {
        paint(a, x, x + 1, x % 2 ? 0xFFFFFF : 0x000000);
        paint(b, x, x + 1, x % 2 ? 0x000000 : 0xFFFFFF);
    }
    assert_ok(flip_compare(a, b, 10, NULL, &near, &error), error);
    assert_ok(flip_compare(a, b, 200, NULL, &far, &error), error);
    assert_true(near.mean > 0.9 && far.mean < 0.1);
}

/* Only the neighbourhood of differences is computed; a single pixel reaches as far as the widest filter, 10 pixels. */
TEST_WITH(the_map_is_local_and_its_mean_the_mean, make, destroy) {
    static float map[SIDE * SIDE];
    double sum = 0;
    paint(a, 0, SIDE, 0xFFFFFF);
    paint(b, 0, SIDE, 0xFFFFFF);
    paint(b, 32, 33, 0x000000);
    double mean = flip(map);
    for (int i = 0; i < SIDE * SIDE; i++) {
        sum += (double)map[i];
        assert_true(map[i] >= 0 && map[i] <= 1);
        if (abs(i % SIDE - 32) > 10) assert_true(map[i] == 0);
    }
    assert_true(map[32 * SIDE + 32] > 0.1f && map[32 * SIDE + 35] > 0);
    assert_near(mean, sum / (SIDE * SIDE), 1e-9);
}

/* Nowhere uniform: reading beyond the region would show. */
static uint32_t busy_grey(int x) { return (uint32_t)(x * 37 % 200) * 0x010101; }

/* Away from the edges, a region has the same values as in a larger picture, which is computed whole. */
TEST_WITH(the_surroundings_do_not_matter, make, destroy) {
    static float small[SIDE * SIDE], large[SIDE * SIDE * 4];
    FlipSummary result;
    float *next = large;
    const FlipSink sink = {keep_row, &next};
    Image *wide_a = image_sized(2 * SIDE, 2 * SIDE), *wide_b = image_sized(2 * SIDE, 2 * SIDE);
    for (int x = 0; x < 2 * SIDE; x++) paint(wide_a, x, x + 1, busy_grey(x)), paint(wide_b, x, x + 1, busy_grey(x));
    for (int x = 0; x < SIDE; x++) paint(a, x, x + 1, busy_grey(x)), paint(b, x, x + 1, busy_grey(x));
    paint(wide_b, 30, 34, 0xFF8000);
    paint(wide_b, 0, 1, 0xFFFFFF);
    paint(wide_b, 2 * SIDE - 1, 2 * SIDE, 0xFFFFFF);
    paint(b, 30, 34, 0xFF8000);
    flip(small);
    assert_ok(flip_compare(wide_a, wide_b, FLIP_PIXELS_PER_DEGREE, &sink, &result, &error), error);
    for (int x = 15; x < 50; x++) assert_near(small[20 * SIDE + x], large[20 * 2 * SIDE + x], 1e-6);
    image_destroy(wide_a);
    image_destroy(wide_b);
}

static double sum_of(const FlipKernel *kernel, bool above) {
    double sum = 0;
    for (int i = 0; i <= 2 * kernel->radius; i++)
        if ((kernel->weights[i] > 0) == above) sum += (double)kernel->weights[i];
    return sum;
}

/* The deviation is half a feature of 0.082 degrees, 2.75 pixels. The first derivative changes sign at 0, the second
   there. */
TEST(kernels_are_derivatives_of_a_gaussian) {
    FlipFeatures features;
    flip_make_features(&features, FLIP_PIXELS_PER_DEGREE);
    int radius = features.edge.radius;
    assert_int_equal(radius, 9);
    assert_near(sum_of(&features.across, true), 1, 1e-6);
    for (int above = 0; above < 2; above++) {
        assert_near(sum_of(&features.edge, above), above ? 1 : -1, 1e-6);
        assert_near(sum_of(&features.point, above), above ? 1 : -1, 1e-6);
    }
    for (int k = 1; k <= radius; k++) {
        assert_true(features.edge.weights[radius + k] == -features.edge.weights[radius - k]);
        assert_true(features.edge.weights[radius + k] < 0);
        assert_true(features.point.weights[radius + k] == features.point.weights[radius - k]);
        assert_true((features.point.weights[radius + k] > 0) == (k > 2));
    }
}

/* Of the Gaussian exp(-x^2 / 2 deviation^2), x in degrees. */
static void assert_gaussian(const FlipKernel *kernel, double deviation) {
    const double width = deviation * FLIP_PIXELS_PER_DEGREE;
    const float *middle = kernel->weights + kernel->radius;
    for (int k = -kernel->radius; k <= kernel->radius; k++)
        assert_near(middle[k] / middle[0], exp(-k * k / (2 * width * width)), 1e-6);
}

/* The constants of the paper's table 1: a1, b1, a2, b2 of a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees, and the
   width of a feature, 0.082 degrees, which is two deviations. A filter is the sum of both Gaussians over all pixels. */
TEST(filters_have_the_published_widths) {
    static const double scale[FLIP_CHANNELS][2] = {{1, 0}, {1, 0}, {34.1, 13.5}},
                        spread[FLIP_CHANNELS][2] = {{0.0047, 1e-5}, {0.0053, 1e-5}, {0.04, 0.025}};
    const double pi = acos(-1);
    FlipFeatures features;
    for (int channel = 0; channel < FLIP_CHANNELS; channel++) {
        FlipBlur blur;
        double whole[2] = {0, 0};
        flip_make_blur(&blur, (FlipChannel)channel, FLIP_PIXELS_PER_DEGREE);
        assert_int_equal(blur.count, scale[channel][1] > 0 ? 2 : 1);
        for (int i = 0; i < blur.count; i++) {
            assert_gaussian(&blur.kernels[i], sqrt(spread[channel][i] / 2) / pi);
            for (int x = -10; x <= 10; x++)
                for (int y = -10; y <= 10; y++)
                    whole[i] += scale[channel][i] * sqrt(pi / spread[channel][i]) *
                                exp(-pi * pi / spread[channel][i] * (x * x + y * y) / pow(FLIP_PIXELS_PER_DEGREE, 2));
        }
        for (int i = 0; i < blur.count; i++) assert_near(blur.share[i], whole[i] / (whole[0] + whole[1]), 1e-5);
    }
    flip_make_features(&features, FLIP_PIXELS_PER_DEGREE);
    assert_gaussian(&features.across, 0.082 / 2);
}

/* Equation 20: the colour's error to the power of 1 - sqrt(feature / sqrt(2)). */
TEST(features_amplify_as_published) {
    for (double feature = 0; feature <= 1; feature += 0.125)
        assert_near(flip_amplify(0.25f, (float)feature), pow(0.25, 1 - sqrt(feature / sqrt(2))), 1e-6);
    assert_near(flip_amplify(0.25f, 2), 1, 1e-6);
    assert_true(flip_amplify(0, 1) == 0);
}

/* Filters a plane along rows, or along columns, of `stride` values; the result begins `radius` after `from`. */
static void filter(const float *from, const FlipKernel *kernel, size_t step, float *to) {
    flip_filter(from, kernel, step, 4 * FLIP_BLOCK, 2 * FLIP_BLOCK, 2 * FLIP_BLOCK, to);
}

/* The kernels sum to 1: a uniform plane stays unchanged, and a step of 1 gives an edge of 1. */
TEST(filters_are_scaled_by_what_they_find) {
    enum { STRIDE = 4 * FLIP_BLOCK, PLANE = STRIDE * STRIDE };
    static float from[PLANE], between[PLANE], to[PLANE];
    FlipFeatures features;
    flip_make_features(&features, FLIP_PIXELS_PER_DEGREE);
    for (int i = 0; i < PLANE; i++) from[i] = 1;
    for (int channel = 0; channel < FLIP_CHANNELS; channel++) {
        FlipBlur blur;
        double sum = 0;
        flip_make_blur(&blur, (FlipChannel)channel, FLIP_PIXELS_PER_DEGREE);
        for (int i = 0; i < blur.count; i++) {
            filter(from, &blur.kernels[i], 1, to);
            sum += (double)(blur.share[i] * to[0]);
            filter(from, &blur.kernels[i], STRIDE, between);
            assert_true(between[0] == to[0]);
        }
        assert_near(sum, 1, 1e-5);
    }
    for (int i = 0; i < PLANE; i++) from[i] = i % STRIDE < 40 ? 0 : 1;
    filter(from, &features.edge, 1, to);
    double largest = 0;
    for (int i = 0; i < 2 * FLIP_BLOCK; i++) largest = fmax(largest, fabs((double)to[i]));
    assert_near(largest, 1, 0.15); /* the step is beside a pixel's centre */
    filter(from, &features.edge, STRIDE, to);
    for (int i = 0; i < 2 * FLIP_BLOCK; i++) assert_near(to[i], 0, 1e-6);
}

static double flip_of_pixels(const uint8_t first[4], const uint8_t second[4]) {
    Error error = {0};
    FlipSummary flip;
    uint8_t pixels[2][4];
    memcpy(pixels[0], first, 4);
    memcpy(pixels[1], second, 4);
    const Image x = {1, 1, pixels[0], NULL}, y = {1, 1, pixels[1], NULL};
    assert_ok(flip_compare(&x, &y, FLIP_PIXELS_PER_DEGREE, NULL, &flip, &error), error);
    assert_near(flip.p99, flip.mean, 1e-7);
    return flip.mean;
}

/* The larger of the values on white and on black. 0.967380 is that of black and white. */
TEST(transparency_is_a_difference) {
    static const uint8_t clear_white[] = {255, 255, 255, 0}, clear_black[] = {0, 0, 0, 0}, black[] = {0, 0, 0, 255},
                         white[] = {255, 255, 255, 255}, half_white[] = {255, 255, 255, 128};
    assert_near(flip_of_pixels(white, clear_white), 0.967380, 1e-5);
    assert_near(flip_of_pixels(clear_white, white), 0.967380, 1e-5);
    assert_near(flip_of_pixels(black, clear_black), 0.967380, 1e-5);
    assert_near(flip_of_pixels(white, half_white), expected_grey(255, 128), 1e-4); /* on black */
    /* Nobody sees the colour of a transparent pixel. */
    assert_true(flip_of_pixels(clear_white, clear_black) == 0);
}

RUN_TESTS(NULL, NULL)
