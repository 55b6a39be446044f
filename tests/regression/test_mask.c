/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "made.h"

#include "regression/image_compare.h"
#include "regression/mask.h"

enum { WIDTH = 6, HEIGHT = 4 };
static Mask mask;

FIXTURE(clear) { mask_free(&mask); }

static uint8_t *made(void) {
    Error error = {0};
    Image *expected = image_sized(WIDTH, HEIGHT);
    uint8_t *masked = calloc(WIDTH * HEIGHT, 1);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        expected->pixels[4 * i] = (uint8_t)i;
        expected->pixels[4 * i + 3] = i % 2 == 0 ? 255 : 128;
    }
    assert_ok(mask_draw(&mask, expected, "frame.png", masked, &error), error);
    image_destroy(expected);
    return masked;
}

TEST_WITH(rectangles_are_cut_at_the_edges, NULL, clear) {
    assert_ok(mask_add_rectangle(&mask, -2, -1, 3, 2, &error), error);
    assert_ok(mask_add_rectangle(&mask, 4, 2, 1000000, 1000000, &error), error);
    assert_ok(mask_add_rectangle(&mask, 100, 100, 5, 5, &error), error);
    uint8_t *masked = made();
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            assert_int_equal(masked[y * WIDTH + x], (x == 0 && y == 0) || (x >= 4 && y >= 2));
    free(masked);
}

/* White, dark, black; the last two transparent, which the opaque file does not preserve. */
TEST_WITH(pictures_mask_where_they_are_not_black, NULL, clear) {
    const char *path = temporary_path("mask.png");
    Image *image = image_sized(WIDTH, HEIGHT);
    image->pixels[4 * 3 + 1] = 1;
    memset(image->pixels + 4 * 7, 255, 3);
    assert_ok(image_write_png(image, path, NULL, 0, &error), error);
    assert_ok(mask_add_picture(&mask, path, &error), error);
    uint8_t *masked = made();
    for (int i = 0; i < WIDTH * HEIGHT; i++) assert_int_equal(masked[i], i == 3 || i == 7);
    free(masked);
    image->width++;
    assert_refused(mask_draw(&mask, image, "frame.png", NULL, &error),
                   "mask.png: error: the mask has 6 x 4 pixels, but frame.png has 7 x 4");
    image_destroy(image);
}

/* Its header and checksums are right, so it is only found out where its pixels are needed; then for each picture. */
TEST_WITH(pictures_with_damaged_pixels_are_refused_when_drawn, NULL, clear) {
    static const uint8_t damaged[] = {
        0x89, 'P',  'N',  'G',  '\r', '\n', 0x1A, '\n', 0,    0,   0,   13,  'I',  'H',  'D',  'R',  0,
        0,    0,    1,    0,    0,    0,    1,    8,    0,    0,   0,   0,   0x3A, 0x7E, 0x9B, 0x55, 0,
        0,    0,    10,   'I',  'D',  'A',  'T',  0x78, 0x01, 7,   0,   0,   0,    0,    0,    0,    0,
        0xD8, 0xE1, 0x07, 0x44, 0,    0,    0,    0,    'I',  'E', 'N', 'D', 0xAE, 0x42, 0x60, 0x82};
    const char *path = temporary_path("damaged.png");
    Image *image = image_sized(1, 1);
    uint8_t masked = 0;
    write_bytes(path, damaged, sizeof damaged);
    assert_ok(mask_add_picture(&mask, path, &error), error);
    for (int i = 0; i < 2; i++) {
        Error found = {0};
        assert_false(mask_draw(&mask, image, "frame.png", &masked, &found));
        assert_error(found, ERROR_INPUT, "damaged.png: error: not a PNG file, or damaged");
    }
    image_destroy(image);
}

/* Opaque ones: the odd pixels are not. */
TEST_WITH(colours_mask_where_the_expected_picture_has_them, NULL, clear) {
    for (int i = 8; i <= 11; i++) assert_ok(mask_add_color(&mask, (const uint8_t[3]){(uint8_t)i, 0, 0}, &error), error);
    assert_ok(mask_add_color(&mask, (const uint8_t[3]){4, 1, 0}, &error), error);
    uint8_t *masked = made();
    for (int i = 0; i < WIDTH * HEIGHT; i++) assert_int_equal(masked[i], i == 8 || i == 10);
    free(masked);
}

TEST_WITH(masked_pixels_do_not_count, NULL, clear) {
    ImageDifference difference;
    Image *a = image_sized(WIDTH, HEIGHT), *b = image_sized(WIDTH, HEIGHT);
    uint8_t masked[WIDTH * HEIGHT] = {[8] = IGNORED_MASK, [9] = IGNORED_MASK, [20] = IGNORED_EDGE, [21] = IGNORED_EDGE};
    a->pixels[4 * 8] = 200, a->pixels[4 * 10] = 3, a->pixels[4 * 22 + 2] = 7, a->pixels[4 * 20] = 90;
    image_compare_masked(a, b, masked, 3, &difference);
    assert_int_equal(difference.beyond, 1);
    assert_int_equal(difference.moved, 1);
    assert_int_equal(difference.counted, WIDTH * HEIGHT - 2);
    assert_int_equal(difference.pixels, 2);
    assert_int_equal(difference.largest, 7);
    assert_true(difference.first_x == 4 && difference.first_y == 1);
    assert_true(difference.left == 4 && difference.top == 1 && difference.right == 5 && difference.bottom == 4);
    masked[10] = masked[22] = IGNORED_MASK;
    image_compare_masked(a, b, masked, 0, &difference);
    assert_true(difference.equal);
    image_destroy(a);
    image_destroy(b);
}

TEST_WITH(the_number_of_masks_is_limited, NULL, clear) {
    for (int i = 0; i < MASK_PARTS; i++) assert_ok(mask_add_rectangle(&mask, 0, 0, 1, 1, &error), error);
    assert_refused(mask_add_rectangle(&mask, 0, 0, 1, 1, &error), "at most 64 masks");
}

RUN_TESTS(NULL, NULL)
