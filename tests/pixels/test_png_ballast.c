/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a file has beside its pixels does not matter, whatever its size; what its pixels have must be sound, however it
   is cut into chunks. Each file is read by both decoders: libpng's is forced by Adam7, which of one pixel is the plain
   order. */
#include "owned.h"

#define PNG_PARTS_ROOM (1 << 23)
#include "png_parts.h"

#include <zlib.h>

static void begin(PngParts *file, bool interlaced) { put_header_of(file, 1, 1, 8, 2 /* RGB */, interlaced); }

/* One red pixel as a zlib stream. */
static size_t red(uint8_t stream[64]) {
    uLongf size = 64;
    assert_int_equal(compress(stream, &size, (const uint8_t[]){0, 255, 0, 0}, 4), Z_OK);
    return size;
}

static void assert_red(const PngParts *file) {
    Error error = {0};
    Image *image = image_decode_png(file->data, file->size, "file.png", IMAGE_MAX_PIXELS, &error);
    assert_ok(image != NULL, error);
    assert_memory_equal(image->pixels, ((const uint8_t[]){255, 0, 0, 255}), 4);
    image_destroy(image);
    assert_ok(is_sound(file, IMAGE_MAX_PIXELS, &error), error);
}

static void assert_damaged(const PngParts *file) {
    Error error = {0};
    assert_refused(image_decode_png(file->data, file->size, "file.png", IMAGE_MAX_PIXELS, &error), "file.png: error: ");
    error = (Error){0};
    assert_false(is_sound(file, IMAGE_MAX_PIXELS, &error));
    assert_int_equal(error.kind, ERROR_INPUT);
}

TEST(other_chunks_have_any_size) {
    static const char *const types[] = {"tEXt", "zTXt", "iTXt", "eXIf", "iCCP", "sPLT", "caBX", "tIME", "vpAg"};
    static const size_t sizes[] = {0, 1, (1 << 16) - 1, 1 << 16, (1 << 16) + 1, 1 << 20};
    static PngParts file;
    uint8_t *ballast = calloc(1 << 20, 1), stream[64];
    const size_t pixels = red(stream);
    for (size_t i = 0; i < sizeof types / sizeof types[0] * 2 * 2; i++)
        for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
            const bool interlaced = i % 2 == 1, after = i / 2 % 2 == 1;
            begin(&file, interlaced);
            if (!after) put_chunk(&file, types[i / 4], ballast, sizes[k]);
            put_chunk(&file, "IDAT", stream, pixels);
            if (after) put_chunk(&file, types[i / 4], ballast, sizes[k]);
            put_chunk(&file, "IEND", NULL, 0);
            assert_red(&file);
            file.data[file.size - 12 - 4]++; /* the checksum of the last chunk before the end */
            assert_damaged(&file);
        }
    free(ballast);
}

/* The text of twinbox behind any other chunk, and before a large one of pixels. */
TEST(texts_are_found_behind_any_chunk) {
    static const char *const types[] = {"tEXt", "zTXt", "iTXt", "eXIf", "iCCP", "sPLT", "caBX", "tIME", "vpAg"};
    static const size_t sizes[] = {0, 1, 1 << 16, (1 << 16) + 1, 1 << 20};
    static PngParts file;
    FREED uint8_t *ballast = calloc(1 << 20, 1);
    char value[16];
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
            begin(&file, false);
            put_chunk(&file, types[i], ballast, sizes[k]);
            put_chunk(&file, "tEXt", "Stat\0before", 11);
            put_chunk(&file, "tEXt", "State\0first", 11);
            put_chunk(&file, "tEXt", "State\0second", 12);
            put_chunk(&file, "IDAT", ballast, 1 << 20);
            put_chunk(&file, "tEXt", "Later\0text", 10);
            put_chunk(&file, "IEND", NULL, 0);
            assert_ok(image_find_text(file.data, file.size, "State", value, sizeof value, &error), error);
            if (strcmp(value, "first") != 0) fail_msg("'%s' behind %zu bytes of %s", value, sizes[k], types[i]);
            assert_ok(image_find_text(file.data, file.size, "Later", value, sizeof value, &error), error);
            assert_string_equal(value, "");
        }
}

/* Files read in pieces, with a large chunk: what displays is held, the rest is not. */
TEST(large_chunks_are_not_held) {
    static const char *const types[] = {"caBX", "eXIf"};
    static PngParts file;
    uint8_t *ballast = calloc(1 << 20, 1), stream[64];
    const size_t pixels = red(stream);
    for (int i = 0; i < 2; i++) {
        error = (Error){0};
        PngFile opened;
        begin(&file, false);
        put_chunk(&file, types[i], ballast, 1 << 20);
        put_chunk(&file, "IDAT", stream, pixels);
        put_chunk(&file, "IEND", NULL, 0);
        const char *path = temporary_path(types[i]);
        write_bytes(path, file.data, file.size);
        assert_ok(png_file_open(&opened, path, IMAGE_MAX_PIXELS, &error), error);
        assert_non_null(opened.rows);
        assert_int_equal(opened.size > 1 << 20, i == 1);
        png_file_close(&opened);
    }
    free(ballast);
}

/* The stream of `size` bytes, then padding, the first `cut` bytes in one chunk, each of the others in its own. */
static void put_pixels(PngParts *file, bool interlaced, const uint8_t *stream, size_t size, size_t cut,
                       size_t padding) {
    static const uint8_t zeros[64];
    begin(file, interlaced);
    if (cut > 0) put_chunk(file, "IDAT", stream, cut);
    for (size_t i = cut; i + 1 < size; i++) put_chunk(file, "IDAT", stream + i, 1);
    uint8_t last[65];
    last[0] = stream[size - 1];
    memcpy(last + 1, zeros, padding);
    put_chunk(file, "IDAT", last, 1 + padding);
    put_chunk(file, "IEND", NULL, 0);
}

TEST(checksums_count_however_they_are_split) {
    static PngParts file;
    uint8_t stream[64];
    const size_t size = red(stream);
    for (size_t cut = 0; cut < size; cut++)
        for (int i = 0; i < 4; i++) {
            const bool interlaced = i % 2 == 1;
            const size_t padding = i / 2 == 1 ? 7 : 0;
            put_pixels(&file, interlaced, stream, size, cut, padding);
            assert_red(&file);
            for (size_t byte = 1; byte <= 4; byte++) {
                stream[size - byte] ^= 0x55;
                put_pixels(&file, interlaced, stream, size, cut, padding);
                assert_damaged(&file);
                stream[size - byte] ^= 0x55;
            }
            put_pixels(&file, interlaced, stream, size - 1, cut < size - 2 ? cut : size - 2, 0);
            assert_damaged(&file);
        }
}

/* Rows of 18 KB that do not shrink, of 8 bits and, for libpng, of 16. */
TEST(noise_in_one_chunk_is_read) {
    enum { BYTES = 18000, DOWN = 40, SIZE = DOWN * (BYTES + 1) };
    static PngParts file;
    FREED uint8_t *rows = malloc(SIZE), *stream = malloc(2 * SIZE);
    uint32_t seed = 1;
    for (size_t i = 0; i < SIZE; i++) {
        seed = seed * 1664525 + 1013904223;
        rows[i] = i % (BYTES + 1) == 0 ? 0 : (uint8_t)(seed >> 24);
    }
    for (int depth = 8; depth <= 16; depth += 8)
        for (int level = 0; level <= 9; level += 3) {
            error = (Error){0};
            uLongf length = 2 * SIZE;
            assert_int_equal(compress2(stream, &length, rows, SIZE, level), Z_OK);
            put_header(&file, BYTES * 8U / 3 / (uint32_t)depth, DOWN, depth, 2);
            put_chunk(&file, "IDAT", stream, length);
            put_chunk(&file, "IEND", NULL, 0);
            OWN(Image) *image = image_decode_png(file.data, file.size, "noise.png", IMAGE_MAX_PIXELS, &error);
            assert_ok(image != NULL, error);
            if (depth == 8) assert_memory_equal(image->pixels, rows + 1, 3);
        }
}

RUN_TESTS(NULL, NULL)
