/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "testing.h"

#include "regression/png_display.h"
#include "pixels/png_parts.h"

static PngParts a, b;

FIXTURE(begin) {
    put_header(&a, 1, 1, 8, 2);
    put_header(&b, 1, 1, 8, 2);
}

static void end(PngParts *png) {
    uint8_t pixels[64];
    put_chunk(png, "IDAT", pixels, compress_zeros(pixels, sizeof pixels, 4));
    put_chunk(png, "IEND", NULL, 0);
}

static void assert_differ(const char *text) {
    end(&a);
    end(&b);
    PngDisplay display;
    Error error = {0};
    assert_ok(png_display_compare(a.data, a.size, b.data, b.size, &display, &error), error);
    assert_string_equal(display.text, text);
}

TEST_WITH(files_without_such_chunks_display_alike, begin, NULL) {
    put_chunk(&a, "tEXt", "Title\0x", 7);
    put_chunk(&b, "tIME", "\x07\xEA\x01\x01\0\0\0", 7);
    assert_differ("");
}

TEST_WITH(gamma_is_told_in_numbers, begin, NULL) {
    put_chunk(&a, "gAMA", "\0\0\xB1\x8F", 4); /* 45455 */
    put_chunk(&b, "gAMA", "\0\1\x86\xA0", 4); /* 100000 */
    assert_differ("gAMA 0.45455 and 1");
}

TEST_WITH(a_chunk_in_one_file_differs_from_none, begin, NULL) {
    static const uint8_t primaries[32] = {1};
    put_chunk(&a, "sRGB", "\0", 1);
    put_chunk(&b, "cICP", "\x0C\x0D\0\1", 4);
    put_chunk(&b, "cHRM", primaries, sizeof primaries);
    assert_differ("cICP none and set, sRGB 0 and none, cHRM none and set");
}

TEST_WITH(values_without_a_short_form_differ, begin, NULL) {
    static const uint8_t first[32] = {1}, second[32] = {2};
    put_chunk(&a, "cHRM", first, sizeof first);
    put_chunk(&b, "cHRM", second, sizeof second);
    assert_differ("cHRM differs");
}

static void put_profile(PngParts *png, const char *name, const char *profile, int effort) {
    uint8_t data[256];
    size_t used = strlen(name) + 2; /* with the NUL and the method, 0 */
    uLongf length = sizeof data - used;
    memset(data, 0, sizeof data);
    memcpy(data, name, strlen(name));
    assert_int_equal(compress2(data + used, &length, (const Bytef *)profile, strlen(profile), effort), Z_OK);
    put_chunk(png, "iCCP", data, used + length);
}

/* An optimiser of PNG files compresses and names it otherwise. */
TEST_WITH(a_profile_is_its_content, begin, NULL) {
    static const char profile[] = "a profile a profile a profile";
    put_profile(&a, "icc", profile, 0);
    put_profile(&b, "ICC profile", profile, 9);
    assert_differ("");
}

TEST_WITH(damaged_profiles_differ_unless_their_bytes_are_equal, begin, NULL) {
    put_chunk(&a, "iCCP", "icc\0\0broken", 11);
    put_chunk(&b, "iCCP", "icc\0\0BROKEN", 11);
    assert_differ("iCCP differs");
}

/* A TIFF header and a directory of two entries. */
static void put_orientation(PngParts *png, bool little, uint8_t value) {
    uint8_t intel[34] = "II*\0\x08\0\0\0\x02\0"
                        "\x0F\x01\x02\0\x01\0\0\0A\0\0\0"
                        "\x12\x01\x03\0\x01\0\0\0";
    uint8_t motorola[34] = "MM\0*\0\0\0\x08\0\x02"
                           "\x01\x0F\0\x02\0\0\0\x01"
                           "A\0\0\0"
                           "\x01\x12\0\x03\0\0\0\x01";
    intel[30] = motorola[31] = value;
    put_chunk(png, "eXIf", little ? intel : motorola, sizeof intel);
}

TEST_WITH(orientations_count_in_both_byte_orders, begin, NULL) {
    put_orientation(&a, true, 6);
    put_orientation(&b, false, 8);
    assert_differ("orientation 6 and 8");
}

TEST_WITH(upright_is_no_orientation, begin, NULL) {
    put_orientation(&a, false, 1);
    assert_differ("");
}

/* Read out of bounds, the sanitizer stops these. */
TEST_WITH(damaged_directories_do_no_harm, begin, NULL) {
    uint8_t exif[34] = "II*\0\x08\0\0\0\xFF\xFF";
    for (size_t size = 0; size <= sizeof exif; size++) {
        begin(NULL);
        uint8_t *copy = malloc(size + 1);
        assert_non_null(copy);
        memcpy(copy, exif, size);
        put_chunk(&a, "eXIf", copy, size);
        free(copy);
        assert_differ("");
    }
    for (int offset = 0; offset < 256; offset++) {
        begin(NULL);
        memset(exif + 4, offset, 4);
        put_chunk(&a, "eXIf", exif, sizeof exif);
        assert_differ("");
    }
}

RUN_TESTS(NULL, NULL)
