/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of a report, read back: every colour of their scales, and sizes beyond one part of the compressor. */
#include "made.h"

#include "regression/regression_internal.h"
#include "regression/image_compare.h"

enum { LEVELS = 256 };

static Image *read_back(uint8_t *file, size_t size) {
    Error error = {0};
    Image *image = file == NULL ? NULL : image_decode_png(file, size, "picture", IMAGE_MAX_PIXELS, &error);
    assert_ok(image != NULL, error);
    free(file);
    return image;
}

static Image *draw(const Image *expected, const Image *actual, const uint8_t *masked) {
    Error error = {0};
    size_t size;
    uint8_t *file = difference_picture(expected, actual, masked, expected->width, expected->height, &size, &error);
    return read_back(file, size);
}

static void assert_pixel(const Image *image, int x, int red, int green, int blue) {
    const uint8_t *p = image->pixels + 4 * x;
    if (p[0] != red || p[1] != green || p[2] != blue || p[3] != 255)
        fail_msg("pixel %d is %d, %d, %d, %d, not %d, %d, %d", x, p[0], p[1], p[2], p[3], red, green, blue);
}

static int luma(const uint8_t *p) { return p[0] * 3 + p[1] * 6 + p[2]; }

/* Pixel x differs by x. The ends are the header's colours; between them each step is darker, or as dark. */
TEST(differences_are_coloured_by_size) {
    Image *expected = image_sized(LEVELS, 1), *actual = image_sized(LEVELS, 1);
    for (int x = 0; x < LEVELS; x++) actual->pixels[4 * x + x % 4] = (uint8_t)x;
    Image *drawn = draw(expected, actual, NULL);
    assert_pixel(drawn, 0, 200, 200, 200); /* equal: pale */
    assert_pixel(drawn, 1, 255, 176, 0);
    assert_pixel(drawn, 255, 72, 0, 110);
    for (int x = 2; x < LEVELS; x++) {
        const uint8_t *p = drawn->pixels + 4 * x;
        assert_true(luma(p) <= luma(p - 4));
        assert_true(p[1] < 200); /* no grey of the background */
    }
    image_destroy(expected);
    image_destroy(actual);
    image_destroy(drawn);
}

TEST(equal_pixels_are_pale) {
    Image *expected = image_sized(LEVELS, 1);
    for (int x = 0; x < LEVELS; x++) memset(expected->pixels + 4 * x, x, 4);
    Image *drawn = draw(expected, expected, NULL);
    for (int x = 0; x < LEVELS; x++) assert_pixel(drawn, x, 200 + x * 55 / 255, 200 + x * 55 / 255, 200 + x * 55 / 255);
    image_destroy(expected);
    image_destroy(drawn);
}

/* Black against white, ignored for one reason: the difference is not coloured. */
static Image *draw_ignored(uint8_t reason) {
    uint8_t masked[LEVELS];
    Image *expected = image_sized(LEVELS, 1), *actual = image_sized(LEVELS, 1);
    memset(actual->pixels, 255, 4 * LEVELS);
    memset(masked, reason, sizeof masked);
    Image *drawn = draw(expected, actual, masked);
    image_destroy(expected);
    image_destroy(actual);
    return drawn;
}

/* In diagonal lines, every eighth pixel. */
TEST(masked_pixels_are_hatched) {
    Image *drawn = draw_ignored(IGNORED_MASK);
    for (int x = 0; x < LEVELS; x++) {
        int grey = x % 8 == 0 ? 120 : 200;
        assert_pixel(drawn, x, grey, grey, grey);
    }
    image_destroy(drawn);
}

TEST(what_limits_allow_is_blue) {
    Image *drawn = draw_ignored(IGNORED_EDGE);
    for (int x = 0; x < LEVELS; x++) assert_pixel(drawn, x, 70, 150, 235);
    image_destroy(drawn);
}

/* Two 16-bit pictures that differ in the last bit count as different by 1. */
TEST(sixteen_bits_count_in_full) {
    uint16_t deep[2][8] = {{0}, {0, 0, 0, 0, 1}};
    Image expected = {2, 1, (uint8_t[8]){0}, deep[0]}, actual = {2, 1, (uint8_t[8]){0}, deep[1]};
    Image *drawn = draw(&expected, &actual, NULL);
    assert_pixel(drawn, 0, 200, 200, 200);
    assert_pixel(drawn, 1, 255, 176, 0);
    image_destroy(drawn);
}

/* Noise does not shrink: 300 KB are ten parts. */
TEST(noise_comes_back) {
    enum { WIDTH = 1000, HEIGHT = 300 };
    Palette palette = {.count = LEVELS};
    size_t size;
    uint32_t seed = 1;
    static uint8_t wanted[HEIGHT * WIDTH];
    for (int i = 0; i < LEVELS; i++) memset(palette.rgb[i], 255 - i, 3);
    IndexedPng *png = indexed_png_create(WIDTH, HEIGHT, &palette, &error);
    assert_ok(png != NULL, error);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) wanted[y * WIDTH + x] = (uint8_t)((seed = seed * 1664525 + 1013904223) >> 24);
        memcpy(indexed_png_row(png), wanted + y * WIDTH, WIDTH);
        assert_ok(indexed_png_add(png, &error), error);
    }
    uint8_t *file = indexed_png_end(png, &size, &error);
    Image *drawn = read_back(file, size);
    for (int i = 0; i < WIDTH * HEIGHT; i++) assert_int_equal(drawn->pixels[4 * i], 255 - wanted[i]);
    indexed_png_destroy(png);
    image_destroy(drawn);
}

/* Equal but for one pixel, 24 x 12 and 16 x 20. */
TEST(what_only_one_picture_has_is_striped) {
    size_t size;
    Image *a = image_sized(24, 12), *b = image_sized(16, 20);
    ImageDifference difference;
    for (int i = 0; i < 24 * 12; i++) a->pixels[4 * i] = (uint8_t)(i % 24 + 9 * (i / 24));
    for (int i = 0; i < 16 * 20; i++) b->pixels[4 * i] = (uint8_t)(i % 16 + 9 * (i / 16));
    b->pixels[4 * (5 * 16 + 7)]++;
    image_compare_masked(a, b, NULL, 0, &difference);
    assert_false(difference.same_size);
    image_cut_to_overlap(a, b);
    assert_true(a->width == 16 && a->height == 12 && b->width == 16 && b->height == 12);
    image_compare_masked(a, b, NULL, 0, &difference);
    assert_true(difference.pixels == 1 && difference.first_x == 7 && difference.first_y == 5);
    uint8_t *file = difference_picture(a, b, NULL, 24, 20, &size, &error);
    Image *drawn = read_back(file, size);
    int striped = 0, colored = 0;
    for (int i = 0; i < 24 * 20; i++) {
        const uint8_t *p = drawn->pixels + 4 * i;
        bool inside = i % 24 < 16 && i / 24 < 12, stripe = p[0] == 150 && p[1] == 120 && p[2] == 175;
        striped += stripe;
        colored += p[0] != p[1];
        assert_false(inside && stripe);
    }
    assert_int_equal(striped, (24 * 20 - 16 * 12) / 2);
    assert_int_equal(colored, striped + 1);
    image_destroy(a);
    image_destroy(b);
    image_destroy(drawn);
}

RUN_TESTS(NULL, NULL)
