/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG files of every kind are read as the pixels they hold; damaged ones are refused. */
#include "made.h"
#include "files.h"

#include "regression/image_compare.h"
#include "png_parts.h"
#include "pngs.h"

static Image *patterned(int width, int height) {
    Image *image = image_sized(width, height);
    uint32_t state = 1;
    for (size_t i = 0; i < (size_t)width * (size_t)height * 4; i++) {
        state = state * 1664525 + 1013904223;
        image->pixels[i] = i % 4 == 3 ? 255 : (uint8_t)(state >> 24);
    }
    return image;
}

TEST(alpha_is_dropped) {
    const char *path = temporary_path("opaque.png");
    OWN(Image) *image = patterned(2, 1);
    image->pixels[3] = 7;
    assert_ok(image_write_png(image, path, NULL, 0, &error), error);
    OWN(Image) *back = image_of(path);
    assert_int_equal(back->pixels[3], 255);
    assert_memory_equal(back->pixels, image->pixels, 3);
}

TEST(texts_come_back) {
    const char *path = temporary_path("text.png");
    const ImageText texts[] = {{"Scene", "pyramid"}, {"Method", "engine | pr\xC3\xA9"}, {"Empty", ""}};
    char value[64];
    OWN(Image) *image = patterned(3, 3);
    assert_ok(image_write_png(image, path, texts, 3, &error), error);
    for (int i = 0; i < 3; i++) {
        text_of_image(path, texts[i].key, value, sizeof value);
        assert_string_equal(value, texts[i].value);
    }
    text_of_image(path, "Author", value, sizeof value);
    assert_string_equal(value, "");
    text_of_image(path, "Scene", value, strlen("pyramid"));
    assert_string_equal(value, "");
}

static const PngKind kinds[] = {{"grey 1", PNG_COLOR_TYPE_GRAY, 1, false},
                                {"grey 2", PNG_COLOR_TYPE_GRAY, 2, false},
                                {"grey 4", PNG_COLOR_TYPE_GRAY, 4, false},
                                {"grey 8", PNG_COLOR_TYPE_GRAY, 8, false},
                                {"grey 16", PNG_COLOR_TYPE_GRAY, 16, false},
                                {"grey 4 tRNS", PNG_COLOR_TYPE_GRAY, 4, true},
                                {"palette 1", PNG_COLOR_TYPE_PALETTE, 1, false},
                                {"palette 4", PNG_COLOR_TYPE_PALETTE, 4, false},
                                {"palette 8", PNG_COLOR_TYPE_PALETTE, 8, false},
                                {"palette 8 tRNS", PNG_COLOR_TYPE_PALETTE, 8, true},
                                {"rgb 8", PNG_COLOR_TYPE_RGB, 8, false},
                                {"rgb 16", PNG_COLOR_TYPE_RGB, 16, false},
                                {"grey alpha 8", PNG_COLOR_TYPE_GRAY_ALPHA, 8, false},
                                {"grey alpha 16", PNG_COLOR_TYPE_GRAY_ALPHA, 16, false},
                                {"rgb alpha 8", PNG_COLOR_TYPE_RGB_ALPHA, 8, false},
                                {"rgb alpha 16", PNG_COLOR_TYPE_RGB_ALPHA, 16, false}};
enum { KINDS = sizeof kinds / sizeof kinds[0] };

static uint8_t to_byte(unsigned value, unsigned largest) { return (uint8_t)((value * 255 + largest / 2) / largest); }

/* The meaning of a sample according to the PNG specification. */
static void expected_pixel(const PngKind *kind, int x, int y, uint8_t pixel[4]) {
    unsigned first = sample(x, y, 0, kind->depth), largest = (1u << kind->depth) - 1;
    bool alpha = kind->color & PNG_COLOR_MASK_ALPHA;
    pixel[3] = kind->transparency && first == 1 ? 0 : 255;
    if (alpha) pixel[3] = to_byte(sample(x, y, channels(kind->color) - 1, kind->depth), largest);
    if (kind->color == PNG_COLOR_TYPE_PALETTE) {
        png_color color = palette_color(first);
        pixel[0] = color.red, pixel[1] = color.green, pixel[2] = color.blue;
        return;
    }
    for (int c = 0; c < 3; c++) {
        int channel = kind->color & PNG_COLOR_MASK_COLOR ? c : 0;
        pixel[c] = to_byte(sample(x, y, channel, kind->depth), largest);
    }
}

TEST(every_kind_is_read) {
    for (int i = 0; i < 2 * KINDS; i++) {
        const PngKind *kind = &kinds[i / 2];
        const char *path = temporary_path("kind.png");
        write_kind(path, kind, i % 2 ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE);
        OWN(Image) *image = image_of(path);
        assert_true(image->width == PNG_SIDE && image->height == PNG_SIDE);
        for (int y = 0; y < PNG_SIDE; y++)
            for (int x = 0; x < PNG_SIDE; x++) {
                uint8_t wanted[4];
                expected_pixel(kind, x, y, wanted);
                if (memcmp(wanted, image->pixels + (y * PNG_SIDE + x) * 4, 4) != 0)
                    fail_msg("%s, interlace %d: pixel %d, %d", kind->name, i % 2, x, y);
            }
    }
}

/* libpng takes a colour beyond the palette for black. */
TEST(colours_beyond_the_palette_are_refused) {
    static const uint8_t palette[3 * 3] = {1, 2, 3, 4, 5, 6, 7, 8, 9}, rows[2] = {0, 0xB0}; /* 2, 3, 0, 0 */
    for (int interlace = 0; interlace < 2; interlace++) {
        PngParts file;
        uint8_t compressed[64];
        uLongf size = sizeof compressed;
        /* The passes of two pixels in a row: one of each. */
        static const uint8_t passes[4] = {0, 0x80, 0, 0xC0};
        assert_int_equal(compress2(compressed, &size, interlace ? passes : rows, interlace ? 4 : 2, 9), Z_OK);
        put_header_of(&file, 2, 1, 2, PNG_COLOR_TYPE_PALETTE, interlace);
        put_chunk(&file, "PLTE", palette, sizeof palette);
        put_chunk(&file, "IDAT", compressed, size);
        put_chunk(&file, "IEND", NULL, 0);
        error = (Error){0};
        assert_null(image_decode_png(file.data, file.size, "beyond.png", IMAGE_MAX_PIXELS, &error));
        assert_error(error, ERROR_INPUT,
                     "beyond.png: error: not a PNG file, or damaged: a colour that is not in the palette");
    }
}

/* A small file with a text before the pixels. */
static char *small_file(size_t *size) {
    Error error = {0};
    const char *path = temporary_path("small.png");
    OWN(Image) *image = patterned(5, 4);
    assert_ok(image_write_png(image, path, &(ImageText){"Scene", "single"}, 1, &error), error);
    return read_whole(path, size);
}

static void refuse(const char *path, const char *text) {
    Error error = {0};
    Image *image = image_read_png(path, &error);
    assert_null(image);
    assert_error(error, ERROR_INPUT, path);
    assert_error(error, ERROR_INPUT, text);
}

static bool check(const void *data, size_t size, Error *error) {
    int width, height;
    *error = (Error){0};
    return png_check(data, size, "x.png", &width, &height, error);
}

/* By the check and by the decoder. */
static void refuse_both(const void *data, size_t size, const char *why) {
    Error error;
    assert_refused(check(data, size, &error), why);
    assert_null(image_decode_png(data, size, "x.png", IMAGE_MAX_PIXELS, &(Error){0}));
}

/* Checksums cover every byte of a PNG after its signature. */
TEST(cut_and_changed_files_are_refused) {
    size_t size;
    FREED char *data = small_file(&size);
    for (size_t length = 0; length < size; length++) refuse_both(data, length, "not a PNG file, or damaged");
    for (size_t bit = 0; bit < size * 8; bit++) {
        data[bit / 8] = (char)(data[bit / 8] ^ 1 << bit % 8);
        refuse_both(data, size, "damaged");
        data[bit / 8] = (char)(data[bit / 8] ^ 1 << bit % 8);
    }
    assert_ok(check(data, size, &error), error);
}

TEST(what_is_no_picture_is_named) {
    static const char pointer[] =
        "version https://git-lfs.github.com/spec/v1\n"
        "oid sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n";
    refuse_both("", 0, "x.png: error: not a PNG file, or damaged: it is empty");
    refuse_both(pointer, sizeof pointer - 1, "x.png: error: a Git LFS pointer, not the file itself; run: git lfs pull");
    refuse_both("\x89PNG\r\n\x1a\n", 8, "unexpected end of file");
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
        refuse_both(png.data, png.size, "the header is invalid");
    }
}

/* Files of 4 x 4 black pixels (RGB: rows of 13 bytes) with these chunks behind the header; IDAT is the whole stream,
   IDA1 and IDA2 are its parts. */
TEST(chunks_out_of_order_are_refused) {
    static const struct {
        const char *chunks[5], *why;
    } cases[] = {{{"IEND"}, "it has no pixels"},
                 {{"IDAT"}, "unexpected end of file"},
                 {{"IDA1", "teXt", "IDA2", "IEND"}, "not consecutive"},
                 {{"NEWS", "IDAT", "IEND"}, "an unknown critical chunk"},
                 {{"xxxx", "IDAT", "IEND"}, "no valid chunk at byte 33"},
                 {{"acTL", "IDAT", "IEND"}, "an animated PNG (chunk acTL at byte 33)"},
                 {{"xxXx", "IDA1", "IDA2", "xxXx", "IEND"}, NULL}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        PngParts png;
        uint8_t pixels[64];
        const size_t size = compress_zeros(pixels, sizeof pixels, 4 * 13);
        put_header(&png, 4, 4, 8, 2);
        for (int k = 0; k < 5 && cases[i].chunks[k] != NULL; k++) {
            const char *type = cases[i].chunks[k];
            const bool first = strcmp(type, "IDA1") == 0, second = strcmp(type, "IDA2") == 0;
            if (memcmp(type, "IDA", 3) == 0)
                put_chunk(&png, "IDAT", pixels + (second ? 10 : 0), first ? 10 : second ? size - 10 : size);
            else
                put_chunk(&png, type, "\0\0\0\1\0\0\0\0", strcmp(type, "acTL") == 0 ? 8 : 0);
        }
        if (cases[i].why != NULL)
            refuse_both(png.data, png.size, cases[i].why);
        else
            assert_ok(check(png.data, png.size, &error), error);
    }
    PngParts png;
    uint8_t pixels[64] = {0x79}; /* no deflate */
    put_header(&png, 4, 4, 8, 2);
    put_chunk(&png, "IDAT", pixels, sizeof pixels);
    put_chunk(&png, "IEND", NULL, 0);
    refuse_both(png.data, png.size, "the pixels are not a zlib stream");
}

/* Deflate gives at most 1032 bytes for one: the best that zlib does lies above the limit, half of it below. */
TEST(pixels_that_cannot_be_complete_are_refused) {
    for (int rows = 2; rows <= 1000; rows += 998) {
        PngParts png;
        uint8_t pixels[4096];
        const size_t size = compress_zeros(pixels, sizeof pixels, (size_t)rows * 3001);
        put_header(&png, 1000, 1000, 8, 2);
        put_chunk(&png, "IDAT", pixels, size);
        put_chunk(&png, "IEND", NULL, 0);
        if (rows < 1000)
            refuse_both(png.data, png.size, "too few bytes for its pixels");
        else
            assert_ok(check(png.data, png.size, &error), error);
    }
}

TEST(large_claims_are_refused_before_they_cost) {
    const char *path = temporary_path("claim.png");
    write_claim(path, 19000, 19000);
    refuse(path, "19000 x 19000 pixels; at most 100000000");
    write_claim(path, 2147483647, 2147483647);
    refuse(path, "claim.png");
    write_claim(path, 100000001, 1);
    refuse(path, "100000001 x 1 pixels");
    write_claim(path, 100000000, 1);
    refuse(path, "damaged"); /* for missing pixels, not for its size */
}

TEST(the_limit_of_pixels_is_the_callers) {
    size_t size;
    FREED uint8_t *data = (uint8_t *)small_file(&size);
    Image *image = image_decode_png(data, size, "small.png", 20, &error);
    assert_ok(image != NULL, error);
    image_destroy(image);
    assert_refused(image_decode_png(data, size, "small.png", 19, &error),
                   "small.png: error: the picture has 5 x 4 pixels; at most 19");
}

/* A sample v of 8 bits is v * 257 in 16. */
TEST(depths_are_compared_by_what_they_mean) {
    ImageDifference difference;
    Image shallow = {1, 1, (uint8_t[]){1, 128, 255, 255}, NULL};
    Image deep = {1, 1, (uint8_t[]){1, 128, 255, 255}, (uint16_t[]){257, 128 * 257, 65535, 65535}};
    image_compare_masked(&shallow, &deep, NULL, 0, &difference);
    assert_true(difference.equal);
    deep.pixels16[0]++;
    image_compare_masked(&shallow, &deep, NULL, 0, &difference);
    assert_true(difference.pixels == 1 && difference.largest == 1);
}

TEST(what_is_no_file_is_refused) {
    assert_refused(image_read_png(temporary_path("missing.png"), &error), "missing.png");
    error = (Error){0};
    assert_null(image_read_png("/", &error));
    assert_int_equal(error.kind, ERROR_INPUT);
}

TEST(a_failed_write_is_the_systems_fault) {
    OWN(Image) *image = patterned(2, 2);
    assert_false(image_write_png(image, temporary_path("no/such/folder.png"), NULL, 0, &error));
    assert_error(error, ERROR_SYSTEM, "no/such/folder.png");
}

RUN_TESTS(NULL, NULL)
