/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/indexed_image.h"

#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

IndexedImage *indexed_image_create(int width, int height, Error *error) {
    IndexedImage *image = malloc(sizeof *image);
    uint8_t *rows = calloc((size_t)width + 1, (size_t)height);
    if (image == NULL || rows == NULL) {
        free(image);
        free(rows);
        error_memory(error, "image");
        return NULL;
    }
    *image = (IndexedImage){.width = width, .height = height, .rows = rows};
    return image;
}

void indexed_image_destroy(IndexedImage *image) {
    if (image == NULL) return;
    free(image->rows);
    free(image);
}

uint8_t *indexed_image_row(const IndexedImage *image, int y) {
    return image->rows + (size_t)y * ((size_t)image->width + 1) + 1;
}

enum { CHUNK_FRAME = 12, IDAT_PART = 1 << 15, IHDR_SIZE = 13, DEPTH = 8, PALETTE = 3 };
static const uint8_t signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};

static uint8_t *put_number(uint8_t *to, uint32_t value) {
    for (int i = 0; i < 4; i++) to[i] = (uint8_t)(value >> (24 - 8 * i));
    return to + 4;
}

/* Length, type, data, CRC of type and data. */
static uint8_t *put_chunk(uint8_t *to, const char *type, const uint8_t *data, size_t size) {
    uint8_t *start = put_number(to, (uint32_t)size);
    memcpy(start, type, 4);
    if (size > 0) memcpy(start + 4, data, size);
    return put_number(start + 4 + size, libdeflate_crc32(0, start, 4 + size));
}

/* Split, as decoders refuse an IDAT chunk that is larger than the picture. */
static uint8_t *put_pixels(uint8_t *to, const uint8_t *data, size_t size) {
    for (size_t at = 0; at < size; at += IDAT_PART)
        to = put_chunk(to, "IDAT", data + at, size - at < IDAT_PART ? size - at : IDAT_PART);
    return to;
}

static uint8_t *make_file(const IndexedImage *image, const uint8_t *packed, size_t packed_size, size_t *size) {
    uint8_t header[IHDR_SIZE] = {0};
    size_t parts = packed_size / IDAT_PART + 1;
    uint8_t *file =
        malloc(sizeof signature + sizeof header + sizeof image->palette + packed_size + (parts + 3) * CHUNK_FRAME);
    if (file == NULL) return NULL;
    put_number(put_number(header, (uint32_t)image->width), (uint32_t)image->height);
    header[8] = DEPTH, header[9] = PALETTE;
    memcpy(file, signature, sizeof signature);
    uint8_t *end = put_chunk(file + sizeof signature, "IHDR", header, sizeof header);
    end = put_chunk(end, "PLTE", image->palette[0], 3 * (size_t)image->colors);
    end = put_chunk(put_pixels(end, packed, packed_size), "IEND", NULL, 0);
    *size = (size_t)(end - file);
    return file;
}

uint8_t *indexed_image_encode(const IndexedImage *image, size_t *size, Error *error) {
    enum { LEVEL = 4 }; /* beyond it, time doubles for a few percent of bytes */
    uint8_t *packed = NULL, *file = NULL;
    size_t bytes = ((size_t)image->width + 1) * (size_t)image->height;
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(LEVEL);
    if (compressor != NULL) {
        size_t most = libdeflate_zlib_compress_bound(compressor, bytes);
        packed = malloc(most);
        size_t used = packed == NULL ? 0 : libdeflate_zlib_compress(compressor, image->rows, bytes, packed, most);
        if (used > 0) file = make_file(image, packed, used, size);
    }
    if (compressor != NULL) libdeflate_free_compressor(compressor);
    free(packed);
    if (file == NULL) error_memory(error, "image");
    return file;
}
