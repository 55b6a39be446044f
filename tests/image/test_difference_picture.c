/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each kind of pixel has its colour, and what lies beyond the pictures is striped. */
#include "testing.h"

#include "image/difference_picture.h"
#include "image/image_compare.h"
#include "image/mask.h"

enum { WIDTH = 16, HEIGHT = 12, CANVAS_WIDTH = 24, CANVAS_HEIGHT = 20 };

static const uint8_t *color_at(const IndexedImage *picture, int x, int y) {
    return picture->palette[indexed_image_row(picture, y)[x]];
}

static bool is_grey(const uint8_t *color) { return color[0] == color[1] && color[1] == color[2]; }

static void kinds_of_pixels_have_colours(void **state) {
    (void)state;
    Error error = {0};
    Image *a = image_create(WIDTH, HEIGHT, &error), *b = image_create(WIDTH, HEIGHT, &error);
    uint8_t masked[WIDTH * HEIGHT] = {0};
    for (int x = 1; x <= 3; x++) b->pixels[4 * x] = x == 1 ? 1 : 255;
    masked[3] = IGNORED_EDGE;
    memset(masked + WIDTH, IGNORED_MASK, WIDTH);
    b->pixels[4 * WIDTH] = 255;
    IndexedImage *picture = difference_picture(a, b, masked, WIDTH, HEIGHT, &error);
    assert_ok(picture != NULL, error);
    assert_int_equal(picture->colors, 256);
    assert_true(is_grey(color_at(picture, 0, 0)));
    assert_memory_equal(color_at(picture, 1, 0), ((uint8_t[]){255, 176, 0}), 3);
    assert_memory_equal(color_at(picture, 2, 0), ((uint8_t[]){72, 0, 110}), 3);
    assert_memory_equal(color_at(picture, 3, 0), ((uint8_t[]){70, 150, 235}), 3);
    for (int x = 0; x < WIDTH; x++) assert_int_equal(color_at(picture, x, 1)[0], (x + 1) % 8 == 0 ? 120 : 200);
    indexed_image_destroy(picture);
    image_destroy(a);
    image_destroy(b);
}

static void pictures_are_cut_to_what_both_have(void **state) {
    (void)state;
    Error error = {0};
    Image *a = image_create(CANVAS_WIDTH, HEIGHT, &error), *b = image_create(WIDTH, CANVAS_HEIGHT, &error);
    ImageDifference difference;
    for (int i = 0; i < CANVAS_WIDTH * HEIGHT; i++)
        a->pixels[4 * i] = (uint8_t)(i % CANVAS_WIDTH + 9 * (i / CANVAS_WIDTH));
    for (int i = 0; i < WIDTH * CANVAS_HEIGHT; i++) b->pixels[4 * i] = (uint8_t)(i % WIDTH + 9 * (i / WIDTH));
    b->pixels[4 * (5 * WIDTH + 7)]++;
    image_compare(a, b, &difference);
    assert_false(difference.same_size);
    image_cut_to_overlap(a, b);
    assert_true(a->width == WIDTH && a->height == HEIGHT && b->width == WIDTH && b->height == HEIGHT);
    image_compare(a, b, &difference);
    assert_true(difference.pixels == 1 && difference.first_x == 7 && difference.first_y == 5);
    IndexedImage *picture = difference_picture(a, b, NULL, CANVAS_WIDTH, CANVAS_HEIGHT, &error);
    assert_ok(picture != NULL, error);
    int striped = 0;
    for (int y = 0; y < CANVAS_HEIGHT; y++)
        for (int x = 0; x < CANVAS_WIDTH; x++) {
            bool inside = x < WIDTH && y < HEIGHT, changed = x == 7 && y == 5;
            assert_true(!inside || changed || is_grey(color_at(picture, x, y)));
            striped += !inside && !is_grey(color_at(picture, x, y));
        }
    assert_int_equal(striped, (CANVAS_WIDTH * CANVAS_HEIGHT - WIDTH * HEIGHT) / 2);
    indexed_image_destroy(picture);
    image_destroy(a);
    image_destroy(b);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kinds_of_pixels_have_colours),
        cmocka_unit_test(pictures_are_cut_to_what_both_have),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
