/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whatever the check refuses, the decoder refuses; and it accepts whatever the decoder accepts. */
#include "owned.h"

#include "base/file.h"
#include "pixels/png.h"
#include "pngs.h"
#include "png_parts.h"

static const PngKind kinds[] = {
    {"grey 1", PNG_COLOR_TYPE_GRAY, 1, false},      {"grey 2", PNG_COLOR_TYPE_GRAY, 2, true},
    {"grey 8", PNG_COLOR_TYPE_GRAY, 8, false},      {"grey 16", PNG_COLOR_TYPE_GRAY, 16, false},
    {"palette 1", PNG_COLOR_TYPE_PALETTE, 1, true}, {"palette 4", PNG_COLOR_TYPE_PALETTE, 4, false},
    {"palette 8", PNG_COLOR_TYPE_PALETTE, 8, true}, {"grey alpha 8", PNG_COLOR_TYPE_GRAY_ALPHA, 8, false},
    {"rgb 8", PNG_COLOR_TYPE_RGB, 8, false},        {"rgb 16", PNG_COLOR_TYPE_RGB, 16, false},
    {"rgba 8", PNG_COLOR_TYPE_RGB_ALPHA, 8, false}, {"rgba 16", PNG_COLOR_TYPE_RGB_ALPHA, 16, false}};

static bool check(const uint8_t *data, size_t size, Error *error) {
    int width, height;
    *error = (Error){0};
    return png_check(data, size, "x.png", &width, &height, error);
}

static bool decodes(const uint8_t *data, size_t size) {
    OWN(Image) *image = image_decode_png(data, size, "x.png", IMAGE_MAX_PIXELS, &(Error){0});
    bool done = image != NULL;
    return done;
}

static void refuse(const uint8_t *data, size_t size, const char *why) {
    Error error;
    assert_refused(check(data, size, &error), why);
    assert_false(decodes(data, size));
}

static uint8_t *kind_bytes(const PngKind *kind, int interlace, size_t *size) {
    Error error = {0};
    const char *path = temporary_path("kind.png");
    write_kind(path, kind, interlace);
    uint8_t *data = (uint8_t *)file_read(path, 1 << 20, size, &error);
    assert_ok(data != NULL, error);
    return data;
}

TEST(every_kind_is_valid) {
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++)
        for (int interlace = 0; interlace < 2; interlace++) {
            size_t size;
            int width = 0, height = 0;
            FREED uint8_t *data = kind_bytes(&kinds[i], interlace, &size);
            assert_ok(png_check(data, size, "x.png", &width, &height, &error), error);
            assert_true(width == PNG_SIDE && height == PNG_SIDE);
        }
}

TEST(cut_and_changed_files_are_refused) {
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        size_t size;
        FREED uint8_t *data = kind_bytes(&kinds[i], 0, &size);
        for (size_t cut = 0; cut < size; cut++) assert_false(check(data, cut, &error));
        for (size_t bit = 0; bit < 8 * size; bit++) {
            data[bit / 8] ^= (uint8_t)(1 << bit % 8);
            assert_false(check(data, size, &error));
            data[bit / 8] ^= (uint8_t)(1 << bit % 8);
        }
    }
}

TEST(what_is_no_picture_is_named) {
    static const char pointer[] =
        "version https://git-lfs.github.com/spec/v1\n"
        "oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n";
    refuse((const uint8_t *)"", 0, "x.png: error: not a PNG file, or damaged: it is empty");
    refuse((const uint8_t *)pointer, sizeof pointer - 1,
           "x.png: error: a Git LFS pointer, not the file itself; run: git lfs pull");
    refuse((const uint8_t *)"hello", 5, "not a PNG file");
    refuse((const uint8_t *)"\x89PNG", 4, "not a PNG file");
    refuse((const uint8_t *)"\x89PNG\r\n\x1a\n", 8, "unexpected end of file");
}

/* Headers of 4 x 4 pixels with these values. */
TEST(headers_are_checked) {
    static const struct {
        uint32_t width, height;
        int depth, color;
    } cases[] = {{0, 4, 8, 2},  {4, 0, 8, 2}, {0x80000000, 4, 8, 2}, {4, 4, 3, 0}, {4, 4, 4, 2},
                 {4, 4, 16, 3}, {4, 4, 0, 0}, {4, 4, 8, 1},          {4, 4, 8, 5}, {4, 4, 8, 7}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        PngParts png;
        uint8_t pixels[64];
        size_t size = compress_zeros(pixels, sizeof pixels, 4 * 13);
        put_header(&png, cases[i].width, cases[i].height, cases[i].depth, cases[i].color);
        put_chunk(&png, "IDAT", pixels, size);
        put_chunk(&png, "IEND", NULL, 0);
        refuse(png.data, png.size, "the header is invalid");
    }
}

/* A valid file of 4 x 4 black pixels (RGB: rows of 13 bytes) up to its pixels. */
static size_t begin(PngParts *png, uint8_t pixels[64]) {
    put_header(png, 4, 4, 8, 2);
    return compress_zeros(pixels, 64, 4 * 13);
}

TEST(chunks_out_of_order_are_refused) {
    PngParts png;
    uint8_t pixels[64];
    size_t size = begin(&png, pixels);
    put_chunk(&png, "IEND", NULL, 0);
    refuse(png.data, png.size, "it has no pixels");

    begin(&png, pixels);
    put_chunk(&png, "IDAT", pixels, size);
    refuse(png.data, png.size, "unexpected end of file");

    begin(&png, pixels);
    put_chunk(&png, "IDAT", pixels, 10);
    put_chunk(&png, "teXt", NULL, 0);
    put_chunk(&png, "IDAT", pixels + 10, size - 10);
    put_chunk(&png, "IEND", NULL, 0);
    refuse(png.data, png.size, "not consecutive");

    begin(&png, pixels);
    put_chunk(&png, "NEWS", NULL, 0);
    put_chunk(&png, "IDAT", pixels, size);
    put_chunk(&png, "IEND", NULL, 0);
    refuse(png.data, png.size, "an unknown critical chunk");

    begin(&png, pixels);
    put_chunk(&png, "acTL", "\0\0\0\1\0\0\0\0", 8);
    put_chunk(&png, "IDAT", pixels, size);
    put_chunk(&png, "IEND", NULL, 0);
    refuse(png.data, png.size, "an animated PNG (chunk acTL at byte 33)");

    put_header(&png, 4, 4, 8, 3);
    put_chunk(&png, "IDAT", pixels, size);
    put_chunk(&png, "IEND", NULL, 0);
    refuse(png.data, png.size, "the palette is missing");
}

TEST(pixels_that_cannot_be_complete_are_refused) {
    PngParts png;
    uint8_t pixels[4096];
    size_t size = begin(&png, pixels);
    pixels[0] = 0x79; /* no deflate */
    put_chunk(&png, "IDAT", pixels, size);
    put_chunk(&png, "IEND", NULL, 0);
    refuse(png.data, png.size, "the pixels are not a zlib stream");

    /* Two rows of 3001 bytes, of 1000. The limit of deflate is 1032 bytes for one. */
    enum { WIDTH = 1000, ROW = 3 * WIDTH + 1 };
    size = compress_zeros(pixels, sizeof pixels, 2 * ROW);
    put_header(&png, WIDTH, 1000, 8, 2);
    put_chunk(&png, "IDAT", pixels, size);
    put_chunk(&png, "IEND", NULL, 0);
    refuse(png.data, png.size, "too few bytes for its pixels");
}

/* The best that zlib does lies above the limit. */
TEST(the_smallest_file_of_a_large_picture_is_valid) {
    PngParts png;
    uint8_t pixels[4096];
    size_t size = compress_zeros(pixels, sizeof pixels, 1000 * 3001);
    put_header(&png, 1000, 1000, 8, 2);
    put_chunk(&png, "IDAT", pixels, size);
    put_chunk(&png, "IEND", NULL, 0);
    assert_ok(check(png.data, png.size, &error), error);
    assert_true(decodes(png.data, png.size));
}

TEST(odd_but_valid_files_are_accepted) {
    PngParts png;
    uint8_t pixels[64];
    size_t size = begin(&png, pixels);
    put_chunk(&png, "xxXx", "?", 1);
    put_chunk(&png, "IDAT", NULL, 0);
    for (size_t i = 0; i < size; i++) put_chunk(&png, "IDAT", pixels + i, 1);
    put_chunk(&png, "xxXx", "?", 1);
    put_chunk(&png, "IEND", NULL, 0);
    put_bytes(&png, "bytes behind the end", 20);
    assert_ok(check(png.data, png.size, &error), error);
    assert_true(decodes(png.data, png.size));
}

RUN_TESTS(NULL, NULL)
