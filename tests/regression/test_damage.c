/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A damaged file is refused in the same words whatever the options: no option may let damage pass. */
#include "made.h"
#include "files.h"

#define PNG_PARTS_ROOM 4096
#include "pixels/png_parts.h"
#include "regression/regression.h"

#include <png.h>

enum { SIDE = 12, KINDS = 4, EDITS = 22, OPTIONS = 6 };

static const struct {
    int depth, color, interlace;
    size_t bytes; /* of all filtered rows */
} kinds[KINDS] = {{8, PNG_COLOR_TYPE_RGB, 0, SIDE *(3 * SIDE + 1)},
                  {16, PNG_COLOR_TYPE_GRAY, 0, SIDE *(2 * SIDE + 1)},
                  {4, PNG_COLOR_TYPE_PALETTE, 0, SIDE *(SIDE / 2 + 1)},
                  {8, PNG_COLOR_TYPE_RGB, 1, 3 * SIDE *SIDE + 2 + 2 + 2 + 3 + 3 + 6 + 6}};

/* A chunk that is added before the place-th of header, palette, pixels in two chunks, text and end. */
static const struct {
    int place;
    const char *type;
    size_t size;
} edits[EDITS] = {{0, "tEXt", 4}, {0, "gAMA", 4},  {1, "IHDR", 13}, {1, "ABCD", 0}, {1, "acTL", 8}, {1, "tEXt", 4},
                  {2, "PLTE", 4}, {2, "tRNS", 9},  {2, "IDAT", 0},  {3, "tEXt", 4}, {3, "ABCD", 2}, {3, "IDAT", 3},
                  {4, "ABCD", 0}, {4, "PLTE", 4},  {4, "PLTE", 48}, {4, "acTL", 8}, {4, "IEND", 0}, {5, "IDAT", 0},
                  {5, "IDAT", 2}, {5, "IHDR", 13}, {5, "A1CD", 0},  {6, "IDAT", 9}};

/* edit: an index, or EDITS for none. */
static void write_picture(const char *path, int kind, int edit) {
    static const uint8_t zeros[64];
    PngParts header, file = {.size = 0};
    uint8_t stream[256];
    const size_t size = compress_zeros(stream, sizeof stream, kinds[kind].bytes);
    put_header_of(&header, SIDE, SIDE, kinds[kind].depth, kinds[kind].color, kinds[kind].interlace);
    put_bytes(&file, header.data, PNG_SIGNATURE);
    for (int place = 0; place <= 6; place++) {
        if (edit < EDITS && edits[edit].place == place) put_chunk(&file, edits[edit].type, zeros, edits[edit].size);
        if (place == 0) put_bytes(&file, header.data + PNG_SIGNATURE, header.size - PNG_SIGNATURE);
        if (place == 1 && kinds[kind].color == PNG_COLOR_TYPE_PALETTE) put_chunk(&file, "PLTE", zeros, 48);
        if (place == 2) put_chunk(&file, "IDAT", stream, 5);
        if (place == 3) put_chunk(&file, "IDAT", stream + 5, size - 5);
        if (place == 4) put_chunk(&file, "tEXt", "a\0b", 3);
        if (place == 5) put_chunk(&file, "IEND", NULL, 0);
    }
    write_bytes(path, file.data, file.size);
}

/* Why the pair cannot be compared; "" if it can. */
static char *answer(const char *expected, const char *actual, int option) {
    Error error = {0};
    Mask mask = {0};
    Regression regression;
    RegressionOptions options = {.max_pixels = IMAGE_MAX_PIXELS, .mask = &mask, .strict = option == 5};
    if (option == 1) options.tolerance = (Tolerance){.given = LIMIT_ANTIALIAS, .antialias = true};
    if (option == 2) options.tolerance = (Tolerance){.given = LIMIT_TOLERANCE, .tolerance = 9};
    if (option == 3) assert_ok(mask_add_rectangle(&mask, 0, 0, 2, 2, &error), error);
    if (option == 4) options.tolerance = (Tolerance){.given = LIMIT_BEYOND, .beyond = {1, false}};
    assert_ok(regression_run(&regression, expected, actual, &options, NULL, &error), error);
    char *why = strdup(regression_was_read(&regression, &error) ? "" : error.message);
    regression_free(&regression);
    mask_free(&mask);
    return why;
}

TEST(no_option_changes_what_is_damage) {
    char sound[256], edited[256];
    int refused = 0;
    snprintf(sound, sizeof sound, "%s", temporary_path("sound.png"));
    snprintf(edited, sizeof edited, "%s", temporary_path("edited.png"));
    for (int kind = 0; kind < KINDS; kind++)
        for (int edit = 0; edit < EDITS; edit++) {
            write_picture(sound, kind, EDITS);
            write_picture(edited, kind, edit);
            FREED char *first = answer(sound, edited, 0), *itself = answer(sound, sound, 0);
            assert_string_equal(itself, "");
            refused += first[0] != '\0';
            for (int option = 1; option < OPTIONS; option++) {
                FREED char *other = answer(sound, edited, option);
                if (strcmp(first, other) != 0)
                    fail_msg("kind %d, %s at %d, option %d: '%s', not '%s'", kind, edits[edit].type, edits[edit].place,
                             option, other, first);
            }
        }
    if (refused < 2 * KINDS * EDITS / 3) fail_msg("%d are refused", refused);
}

RUN_TESTS(NULL, NULL)
