/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Content that moved by whole pixels passes; content that appeared, vanished or changed does not. Limits of a
   region. */
#include "made.h"

#include "regression/compare.h"
#include "regression/regression_internal.h"
#include "regression/regression.h"

enum { WIDTH = 40, HEIGHT = 24 };

/* Each text is a picture of rows; a letter is a colour. The rest is white. */
static Image *picture(int x, int y, const char *const *rows) {
    Image *image = image_sized(WIDTH, HEIGHT);
    memset(image->pixels, 255, (size_t)4 * WIDTH * HEIGHT);
    for (int row = 0; rows[row] != NULL; row++)
        for (int i = 0; rows[row][i] != '\0'; i++)
            if (rows[row][i] != ' ')
                memset(image->pixels + 4 * ((y + row) * WIDTH + x + i), rows[row][i] == 'g' ? 120 : 10, 3);
    return image;
}

static ImageDifference difference_of(const Image *a, const Image *b, int reach, int tolerance) {
    uint8_t masked[WIDTH * HEIGHT] = {0};
    ImageDifference difference;
    shift_mark(a, b, reach, tolerance, masked);
    image_compare_masked(a, b, masked, tolerance, &difference);
    return difference;
}

/* Destroys both. */
static int64_t left(Image *a, Image *b, int reach) {
    const ImageDifference difference = difference_of(a, b, reach, 0);
    assert_true(difference.pixels + difference.moved > 0);
    image_destroy(a);
    image_destroy(b);
    return difference.pixels;
}

static const char *const letter[] = {"xx xx", "xgggx", "x   x", "x   x", NULL};
static const char *const letter_without_a_pixel[] = {"xx xx", "xgggx", "x   x", "x    ", NULL};
static const char *const letter_of_another_colour[] = {"xx xx", "xxggx", "x   x", "x   x", NULL};
static const char *const letter_and_dot[] = {"xx xx", "xgggx", "x   x", "x   x x", NULL};
static const char *const line[] = {"xxxxxxxxxxxxxxx", NULL};
static const char *const shorter_line[] = {"xxxxxxxxxxxxxx", NULL};
static const char *const thick_line[] = {"xxxxxxxxxxxxxxx", "xxxxxxxxxxxxxxx", NULL};
static const char *const dot[] = {"x", NULL};
static const char *const dots[] = {"x  x", NULL};
static const char *const ring[] = {" xxx ", "x   x", "x   x", " xxx ", NULL};
static const char *const nothing[] = {NULL};
static const char *const *const contents[] = {letter, line, thick_line, dot, dots, ring};
enum { CONTENTS = sizeof contents / sizeof *contents };

TEST(content_may_move_as_far_as_the_rule_says) {
    for (int i = 0; i < CONTENTS; i++)
        for (int reach = 1; reach <= 4; reach++)
            for (int dy = -5; dy <= 5; dy++)
                for (int dx = -5; dx <= 5; dx++) {
                    const bool passes = abs(dx) <= reach && abs(dy) <= reach;
                    if (dx == 0 && dy == 0) continue;
                    if ((left(picture(15, 10, contents[i]), picture(15 + dx, 10 + dy, contents[i]), reach) == 0) !=
                        passes)
                        fail_msg("content %d moved by %d, %d, rule %d: not %d", i, dx, dy, reach, passes);
                }
}

TEST(nothing_may_vanish_or_appear) {
    for (int i = 0; i < CONTENTS; i++) {
        assert_true(left(picture(15, 10, contents[i]), picture(15, 10, nothing), 2) > 0);
        assert_true(left(picture(15, 10, nothing), picture(15, 10, contents[i]), 2) > 0);
    }
}

TEST(moved_content_must_be_the_same) {
    for (int dx = 0; dx <= 1; dx++) {
        assert_true(left(picture(15, 10, letter), picture(15 + dx, 10, letter_without_a_pixel), 1) > 0);
        assert_true(left(picture(15, 10, letter), picture(15 + dx, 10, letter_of_another_colour), 1) > 0);
        assert_true(left(picture(15, 10, letter), picture(15 + dx, 10, letter_and_dot), 2) > 0);
        assert_true(left(picture(15, 10, line), picture(15 + dx, 10, shorter_line), 1) > 0);
        assert_true(left(picture(15, 10, line), picture(15, 10 - dx, thick_line), 1) > 0);
    }
}

/* What leaves the picture has vanished. */
TEST(content_must_stay_in_the_picture) {
    assert_int_equal(left(picture(1, 10, letter), picture(0, 10, letter), 1), 0);
    assert_int_equal(left(picture(WIDTH - 6, 10, letter), picture(WIDTH - 5, 10, letter), 1), 0);
    Image *a = picture(0, 10, letter), *b = picture(0, 10, nothing);
    for (size_t row = 0; row < HEIGHT; row++)
        memcpy(b->pixels + 4 * row * WIDTH, a->pixels + 4 * (row * WIDTH + 1), (size_t)4 * (WIDTH - 1));
    assert_true(left(a, b, 1) > 0);
}

/* Each island has its own offset; one that changed does not hide behind one that moved. */
TEST(islands_are_judged_alone) {
    Image *a = picture(5, 4, letter), *b = picture(6, 4, letter), *other = picture(25, 14, ring);
    for (size_t i = 0; i < (size_t)4 * WIDTH * HEIGHT; i++)
        if (other->pixels[i] != 255) a->pixels[i] = other->pixels[i];
    image_destroy(other);
    assert_int_equal(left(a, b, 1), 10); /* the ring's pixels */
}

/* A dot two pixels from a letter stays, while the letter moves away. */
TEST(neighbours_may_stay) {
    Image *a = picture(15, 10, letter), *b = picture(14, 10, letter);
    for (int c = 0; c < 3; c++) a->pixels[4 * (11 * WIDTH + 21) + c] = b->pixels[4 * (11 * WIDTH + 21) + c] = 0;
    assert_int_equal(left(a, b, 1), 0);
}

/* Noise within the tolerance beside a movement; and the low byte of 16 bits counts without one. */
TEST(tolerance_applies_to_moved_content) {
    Image *a = picture(15, 10, letter), *b = picture(16, 10, letter);
    for (size_t i = 0; i < (size_t)4 * WIDTH * HEIGHT; i += 7) b->pixels[i] = (uint8_t)(b->pixels[i] - 2);
    assert_true(difference_of(a, b, 1, 2).beyond == 0);
    assert_true(difference_of(a, b, 1, 1).beyond > 0);
    image_destroy(a);
    image_destroy(b);
}

static ImageDifference by_rules(const char *text, const Image *a, const Image *b) {
    uint8_t masked[WIDTH * HEIGHT] = {0};
    ImageDifference difference;
    Error error = {0};
    Rules *rules = rules_read(write_bytes(temporary_path("compare.yaml"), text, strlen(text)), &error);
    assert_ok(rules != NULL, error);
    assert_true(rules_have_regions(rules, "a.png") && !rules_have_regions(rules, "b.png"));
    Tolerance whole = {0};
    rules_override(rules, "a.png", &whole);
    assert_int_equal(whole.given, 0);
    assert_ok(rules_mark_regions(rules, "a.png", a, b, masked, &error), error);
    rules_destroy(rules);
    image_compare_masked(a, b, masked, 0, &difference);
    return difference;
}

TEST(limits_of_a_region_count_in_it) {
    Image *a = picture(15, 10, letter), *b = picture(16, 10, letter);
    b->pixels[0] = 250;
    b->pixels[4 * (10 * WIDTH)] = 250;
    assert_int_equal(by_rules("rules: [{files: a.png, region: [10, 5, 20, 15], shift: 1}]", a, b).pixels, 2);
    assert_int_equal(by_rules("rules: [{files: a.png, region: [0, 0, 1, 9], tolerance: 5}]", a, b).left, 0);
    ImageDifference level = by_rules("rules: [{files: a.png, region: [0, 0, 1, 24], tolerance: 5}]", a, b);
    assert_true(level.left >= 15 && level.moved == 2);
    assert_int_equal(by_rules("rules: [{files: a.png, region: [0, 0, 1, 24], tolerance: 4}]", a, b).first_y, 0);
    image_destroy(a);
    image_destroy(b);
}

/* A column that vanishes at the edge of the region has not moved out of it. */
TEST(content_does_not_leave_a_region_unnoticed) {
    Image *a = picture(15, 10, dot), *b = picture(15, 10, nothing);
    assert_int_equal(by_rules("rules: [{files: a.png, region: [0, 0, 16, 24], shift: 1}]", a, b).pixels, 1);
    image_destroy(a);
    image_destroy(b);
}

/* A frame nearly as large as the picture: its island takes the most steps. */
static Image *framed(int x, int y) {
    enum { W = 480, H = 270, MARGIN = 20 };
    Image *image = image_sized(W, H);
    memset(image->pixels, 255, (size_t)4 * W * H);
    for (int i = MARGIN; i < W - MARGIN; i++)
        for (int k = MARGIN; k < H - MARGIN; k++)
            if (i == MARGIN || k == MARGIN || i == W - MARGIN - 1 || k == H - MARGIN - 1)
                memset(image->pixels + 4 * ((k + y) * W + i + x), 0, 3);
    return image;
}

TEST(a_whole_chart_may_move) {
    for (int reach = 1; reach <= FEW_PIXELS_MAX; reach++) {
        Image *a = framed(0, 0), *b = framed(reach, -reach);
        uint8_t *masked = calloc((size_t)a->width * (size_t)a->height, 1);
        ImageDifference difference;
        assert_non_null(masked);
        shift_mark(a, b, reach, 0, masked);
        image_compare_masked(a, b, masked, 0, &difference);
        if (difference.pixels > 0) fail_msg("moved by %d: %d pixels count", reach, (int)difference.pixels);
        free(masked);
        image_destroy(a);
        image_destroy(b);
    }
}

/* Noise everywhere is no island, and ends. */
TEST(noise_is_no_movement) {
    Image *a = image_sized(WIDTH, HEIGHT), *b = image_sized(WIDTH, HEIGHT);
    uint32_t random = 1;
    for (size_t i = 0; i < (size_t)4 * WIDTH * HEIGHT; i++) {
        random = random * 1664525 + 1013904223;
        a->pixels[i] = (uint8_t)(random >> 24);
        b->pixels[i] = (uint8_t)(random >> 16);
    }
    assert_int_equal(difference_of(a, b, FEW_PIXELS_MAX, 0).moved, 0);
    image_destroy(a);
    image_destroy(b);
}

RUN_TESTS(NULL, NULL)
