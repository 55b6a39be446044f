/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files of the encoder, read back by libpng and pngcheck: every kind of picture, and sequences of which only changed
   rows are compressed again. */
#include "made.h"

#include "base/file.h"
#include "regression/image_compare.h"

static uint32_t seed = 1;

static unsigned any_below(unsigned limit) {
    seed = seed * 1664525 + 1013904223;
    return (unsigned)((uint64_t)(seed >> 8) * limit >> 24);
}

static Image *blank_image(int width, int height) {
    Image *image = image_sized(width, height);
    memset(image->pixels, 255, (size_t)width * (size_t)height * 4);
    return image;
}

static void set_pixel(Image *image, int x, int y, uint32_t rgb) {
    uint8_t *pixel = image->pixels + ((size_t)y * (size_t)image->width + (size_t)x) * 4;
    for (int c = 0; c < 3; c++) pixel[c] = (uint8_t)(rgb >> (8 * c));
}

static uint32_t random_color(void) { return any_below(1u << 24); }

/* Noise; one colour; horizontal and vertical stripes; rectangles; noise in some rows. */
enum { NOISE, FLAT, ACROSS, DOWN, BOXES, ROUGH, KINDS };

static void fill(Image *image, int kind) {
    uint32_t colors[2] = {random_color(), random_color()};
    unsigned step = 1 + any_below(200);
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            unsigned i = (unsigned)(kind == ACROSS ? y : x) / step;
            bool noisy = kind == NOISE || (kind == ROUGH && y % 5 == 0);
            set_pixel(image, x, y, noisy ? random_color() : colors[kind == FLAT ? 0 : i % 2]);
        }
}

/* A rectangle of one colour; its rows are marked. */
static void add_box(Image *image, bool *changed) {
    int left = (int)any_below((unsigned)image->width), top = (int)any_below((unsigned)image->height);
    int width = (int)any_below(100), height = (int)any_below(20);
    uint32_t color = random_color();
    for (int y = top; y < image->height && y < top + height; y++) {
        changed[y] = true;
        for (int x = left; x < image->width && x < left + width; x++) set_pixel(image, x, y, color);
    }
}

static void assert_holds(const uint8_t *data, size_t size, const Image *image) {
    Error error = {0};
    const char *path = temporary_path("holds.png");
    assert_ok(file_write(path, data, size, &error), error);
    OWN(Image) *back = image_of(path);
    ImageDifference difference;
    image_compare_masked(image, back, NULL, 0, &difference);
    assert_true(difference.equal);
}

/* pngcheck is stricter than decoders. */
static void assert_checked(void) {
    assert_int_equal(system(printed("pngcheck -q '%s' >/dev/null", temporary_path("holds.png"))), 0);
}

TEST(every_picture_comes_back) {
    static const int sizes[][2] = {{1, 1},  {1, 200}, {200, 1},  {2, 3},    {86, 4},  {87, 4},
                                   {88, 4}, {173, 5}, {300, 40}, {2000, 9}, {8192, 3}};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        for (int kind = 0; kind < KINDS; kind++)
            for (PngEffort effort = PNG_FAST; effort <= PNG_SMALL; effort++) {
                const uint8_t *data;
                size_t size;
                OWN(Image) *image = blank_image(sizes[i][0], sizes[i][1]);
                OWN(PngEncoder) *encoder = png_encoder_create(image->width, image->height, effort, &error);
                assert_ok(encoder != NULL, error);
                fill(image, kind);
                assert_ok(png_encode(encoder, image, NULL, NULL, 0, &data, &size, &error), error);
                assert_holds(data, size, image);
                assert_checked();
            }
}

TEST(random_pictures_come_back) {
    for (int i = 0; i < 400; i++) {
        const uint8_t *data;
        size_t size;
        bool ignored[64];
        OWN(Image) *image = blank_image(1 + (int)any_below(300), 1 + (int)any_below(40));
        OWN(PngEncoder) *encoder = png_encoder_create(image->width, image->height, PNG_FAST, &error);
        fill(image, (int)any_below(KINDS));
        for (unsigned box = any_below(9); box > 0; box--) add_box(image, ignored);
        assert_ok(png_encode(encoder, image, NULL, NULL, 0, &data, &size, &error), error);
        assert_holds(data, size, image);
    }
}

/* The bytes equal those of a new encoder, whatever was encoded before. */
TEST(kept_rows_change_no_byte) {
    enum { WIDTH = 230, HEIGHT = 61 };
    OWN(Image) *image = blank_image(WIDTH, HEIGHT);
    OWN(PngEncoder) *encoder = png_encoder_create(WIDTH, HEIGHT, PNG_FAST, &error);
    for (int frame = 0; frame < 200; frame++) {
        bool changed[HEIGHT] = {false};
        const uint8_t *data, *fresh_data;
        size_t size, fresh_size;
        if (frame > 0)
            for (unsigned box = any_below(3); box > 0; box--) add_box(image, changed);
        assert_ok(png_encode(encoder, image, frame > 0 ? changed : NULL, NULL, 0, &data, &size, &error), error);
        OWN(PngEncoder) *fresh = png_encoder_create(WIDTH, HEIGHT, PNG_FAST, &error);
        assert_ok(png_encode(fresh, image, NULL, NULL, 0, &fresh_data, &fresh_size, &error), error);
        assert_true(size == fresh_size && memcmp(data, fresh_data, size) == 0);
    }
}

/* Rows not flagged as changed are not read. */
TEST(only_changed_rows_are_read) {
    bool none[40] = {false};
    const uint8_t *data;
    size_t size;
    OWN(Image) *image = blank_image(50, 40), *first = blank_image(50, 40);
    OWN(PngEncoder) *encoder = png_encoder_create(50, 40, PNG_FAST, &error);
    assert_ok(png_encode(encoder, image, NULL, NULL, 0, &data, &size, &error), error);
    fill(image, NOISE);
    assert_ok(png_encode(encoder, image, none, NULL, 0, &data, &size, &error), error);
    assert_holds(data, size, first);
}

TEST(small_is_smaller) {
    const uint8_t *data;
    size_t sizes[2];
    bool ignored[400];
    OWN(Image) *image = blank_image(640, 360);
    for (int box = 0; box < 60; box++) add_box(image, ignored);
    for (PngEffort effort = PNG_FAST; effort <= PNG_SMALL; effort++) {
        OWN(PngEncoder) *encoder = png_encoder_create(640, 360, effort, &error);
        assert_ok(png_encode(encoder, image, NULL, NULL, 0, &data, &sizes[effort], &error), error);
    }
    assert_true(sizes[PNG_SMALL] < sizes[PNG_FAST]);
    assert_true(sizes[PNG_FAST] < 640 * 360 * 3 / 20);
}

RUN_TESTS(NULL, NULL)
