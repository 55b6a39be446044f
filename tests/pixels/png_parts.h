/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG files made of single chunks with valid checksums. Include testing.h first. */
#pragma once
#include "pixels/png.h"
#include <zlib.h>

#ifndef PNG_PARTS_ROOM
#define PNG_PARTS_ROOM (1 << 16)
#endif

typedef struct PngParts {
    uint8_t data[PNG_PARTS_ROOM];
    size_t size;
} PngParts;

static inline void put_bytes(PngParts *parts, const void *data, size_t size) {
    assert_true(parts->size + size <= sizeof parts->data);
    if (size > 0) memcpy(parts->data + parts->size, data, size);
    parts->size += size;
}

static inline void store_number(uint8_t to[4], uint32_t value) {
    for (int i = 0; i < 4; i++) to[i] = (uint8_t)(value >> (24 - 8 * i));
}

static inline void put_number(PngParts *parts, uint32_t value) {
    uint8_t bytes[4];
    store_number(bytes, value);
    put_bytes(parts, bytes, sizeof bytes);
}

static inline void put_chunk(PngParts *parts, const char *type, const void *data, size_t size) {
    put_number(parts, (uint32_t)size);
    size_t start = parts->size;
    put_bytes(parts, type, 4);
    put_bytes(parts, data, size);
    put_number(parts, (uint32_t)crc32(0, parts->data + start, (uInt)(size + 4)));
}

static inline void put_header_of(PngParts *parts, uint32_t width, uint32_t height, int depth, int color,
                                 int interlace) {
    uint8_t data[13] = {0};
    store_number(data, width);
    store_number(data + 4, height);
    data[8] = (uint8_t)depth, data[9] = (uint8_t)color, data[12] = (uint8_t)interlace;
    parts->size = 0;
    put_bytes(parts, "\x89PNG\r\n\x1a\n", 8);
    put_chunk(parts, "IHDR", data, sizeof data);
}

static inline void put_header(PngParts *parts, uint32_t width, uint32_t height, int depth, int color) {
    put_header_of(parts, width, height, depth, color, 0);
}

/* Whether png_file_check() finds the file sound. */
static inline bool is_sound(const PngParts *parts, int64_t max_pixels, Error *error) {
    PngFile file;
    const char *path = write_bytes(temporary_path("parts.png"), parts->data, parts->size);
    if (!png_file_open(&file, path, max_pixels, error)) return false;
    const bool sound = png_file_check(&file, error);
    png_file_close(&file);
    return sound;
}

/* Compressed zeros: black pixels, if they are as many as the header tells. */
static inline size_t compress_zeros(uint8_t *compressed, size_t room, size_t size) {
    uLongf length = (uLongf)room;
    uint8_t *zeros = calloc(size, 1);
    assert_non_null(zeros);
    assert_int_equal(compress2(compressed, &length, zeros, (uLong)size, 9), Z_OK);
    free(zeros);
    return length;
}
