/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whichever allocation fails, also of libpng: the result is that of enough memory, or a system error. Never is the file
   called damaged, a text missing, or a colour profile different. */
#include "made.h"

#include "allocations.h"
#include "regression/png_display.h"
#include "pixels/pixels_internal.h"
#include "png_parts.h"
#include "pngs.h"

static const ImageText text = {"Scene",
                               "a stack of boxes, long enough for libpng to lengthen its buffers once or twice"};

/* Runs `work` with the n-th allocation failing, for each n. Returns how often it failed. */
static int count_failures(void (*work)(Error *error)) {
    int failures = 0;
    failed_allocations = 1;
    for (int n = 1; failed_allocations > 0; n++) {
        Error error = {0};
        failed_allocations = 0;
        failing_allocation = n;
        work(&error);
        failing_allocation = 0;
        if (error.kind == ERROR_NONE) continue;
        assert_error(error, ERROR_SYSTEM, "out of memory");
        failures++;
    }
    return failures;
}

/* One failure alone may be made good: the fast decoder's by libpng. */
static void fail_each(void (*work)(Error *error)) {
    later_ones_fail = false;
    count_failures(work);
    later_ones_fail = true;
    assert_true(count_failures(work) > 0);
}

static const uint8_t *file;
static size_t file_size;

static void load(const char *path) {
    Error error = {0};
    free((void *)file);
    file = image_load_png(path, &file_size, &error);
    assert_ok(file != NULL, error);
}

FIXTURE(unload) {
    free((void *)file);
    file = NULL;
}

static void decode(Error *error) {
    OWN(Image) *image = image_decode_png(file, file_size, "a.png", IMAGE_MAX_PIXELS, error);
    assert_int_equal(image != NULL, error->kind == ERROR_NONE);
    if (image != NULL) assert_int_equal(image->width, PNG_SIDE);
}

/* Interlaced, or with 16 bits, a file is read by libpng. */
TEST_WITH(no_picture_is_called_damaged, NULL, unload) {
    static const PngKind kinds[] = {{"rgb", PNG_COLOR_TYPE_RGB, 8, false},
                                    {"palette", PNG_COLOR_TYPE_PALETTE, 4, true},
                                    {"rgba16", PNG_COLOR_TYPE_RGB_ALPHA, 16, false}};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        for (int interlace = 0; interlace < 2; interlace++) {
            const char *path = temporary_path("kind.png");
            write_kind(path, &kinds[i], interlace);
            load(path);
            fail_each(decode);
        }
}

static void find_text(Error *error) {
    char value[128];
    if (image_find_text(file, file_size, text.key, value, sizeof value, error)) assert_string_equal(value, text.value);
}

TEST_WITH(no_text_is_called_missing, NULL, unload) {
    Image *image = image_sized(3, 2);
    assert_ok(image_write_png(image, temporary_path("text.png"), &text, 1, &error), error);
    image_destroy(image);
    load(temporary_path("text.png"));
    fail_each(find_text);
}

static PngParts a, b;

static void put_profile(PngParts *png, int effort) {
    static const char profile[] = "a profile a profile a profile";
    uint8_t data[256] = "icc";
    uLongf length = sizeof data - 5;
    assert_int_equal(compress2(data + 5, &length, (const Bytef *)profile, sizeof profile, effort), Z_OK);
    put_header(png, 1, 1, 8, 2);
    put_chunk(png, "iCCP", data, 5 + length);
    put_chunk(png, "IEND", NULL, 0);
}

static void compare(Error *error) {
    PngDisplay display;
    if (png_display_compare(a.data, a.size, b.data, b.size, &display, error)) assert_string_equal(display.text, "");
}

TEST(no_profile_is_called_different) {
    put_profile(&a, 0);
    put_profile(&b, 9);
    fail_each(compare);
}

static PngEffort effort;

static void encode(Error *error) {
    const uint8_t *data;
    size_t size;
    OWN(Image) *image = image_create(40, 30, error);
    OWN(PngEncoder) *encoder = image != NULL ? png_encoder_create(40, 30, effort, error) : NULL;
    if (encoder != NULL && png_encode(encoder, image, NULL, &text, 1, &data, &size, error))
        assert_memory_equal(data + size - 8, "IEND", 4);
}

TEST(encoding_names_the_lack_of_memory) {
    for (effort = PNG_FAST; effort <= PNG_SMALL; effort++) fail_each(encode);
}

RUN_TESTS(NULL, NULL)
