/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "image/indexed_png.h"

#include "common/array.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { CHUNK_FRAME = 12, IDAT_PART = 1 << 15, IHDR_SIZE = 13, DEPTH = 8, PALETTE = 3 };

struct IndexedPng {
    int width;
    uint8_t *row; /* [1 + width]: PNG's mark of an unfiltered row, 0, and the pixels */
    z_stream stream;
    uint8_t *file;
    size_t size, capacity;
    uint8_t part[IDAT_PART]; /* of the compressed pixels */
};

static void put_number(uint8_t *to, uint32_t value) {
    for (int i = 0; i < 4; i++) to[i] = (uint8_t)(value >> (24 - 8 * i));
}

/* Length, type, data, CRC of type and data. */
static bool put_chunk(IndexedPng *png, const char *type, const uint8_t *data, size_t size, Error *error) {
    if (!array_reserve((void **)&png->file, &png->capacity, png->size + size + CHUNK_FRAME, 1))
        return error_memory(error, "image");
    uint8_t *to = png->file + png->size;
    put_number(to, (uint32_t)size);
    memcpy(to + 4, type, 4);
    if (size > 0) memcpy(to + 8, data, size);
    put_number(to + 8 + size, (uint32_t)crc32_z(0, to + 4, size + 4));
    png->size += size + CHUNK_FRAME;
    return true;
}

static bool put_start(IndexedPng *png, int height, const Palette *palette, Error *error) {
    static const uint8_t signature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    uint8_t header[IHDR_SIZE] = {[8] = DEPTH, [9] = PALETTE};
    put_number(header, (uint32_t)png->width);
    put_number(header + 4, (uint32_t)height);
    if (!array_reserve((void **)&png->file, &png->capacity, sizeof signature, 1)) return error_memory(error, "image");
    memcpy(png->file, signature, sizeof signature);
    png->size = sizeof signature;
    return put_chunk(png, "IHDR", header, sizeof header, error) &&
           put_chunk(png, "PLTE", palette->rgb[0], 3 * (size_t)palette->count, error);
}

IndexedPng *indexed_png_create(int width, int height, const Palette *palette, Error *error) {
    enum { LEVEL = 3 }; /* from 4 on, time doubles for a tenth of the bytes */
    IndexedPng *png = calloc(1, sizeof *png);
    uint8_t *row = calloc((size_t)width + 1, 1);
    if (png == NULL || row == NULL || deflateInit(&png->stream, LEVEL) != Z_OK) {
        free(png);
        free(row);
        error_memory(error, "image");
        return NULL;
    }
    png->width = width, png->row = row;
    png->stream.next_out = png->part, png->stream.avail_out = IDAT_PART;
    if (put_start(png, height, palette, error)) return png;
    indexed_png_destroy(png);
    return NULL;
}

void indexed_png_destroy(IndexedPng *png) {
    if (png == NULL) return;
    deflateEnd(&png->stream);
    free(png->row);
    free(png->file);
    free(png);
}

uint8_t *indexed_png_row(IndexedPng *png) { return png->row + 1; }

/* Each full part becomes a chunk: decoders refuse an IDAT chunk that is larger than the picture. */
static bool put_part(IndexedPng *png, Error *error) {
    if (!put_chunk(png, "IDAT", png->part, IDAT_PART - png->stream.avail_out, error)) return false;
    png->stream.next_out = png->part, png->stream.avail_out = IDAT_PART;
    return true;
}

bool indexed_png_add(IndexedPng *png, Error *error) {
    png->stream.next_in = png->row, png->stream.avail_in = (uInt)png->width + 1;
    do {
        deflate(&png->stream, Z_NO_FLUSH);
        if (png->stream.avail_out == 0 && !put_part(png, error)) return false;
    } while (png->stream.avail_in > 0);
    return true;
}

uint8_t *indexed_png_end(IndexedPng *png, size_t *size, Error *error) {
    for (bool ended = false; !ended;) {
        ended = deflate(&png->stream, Z_FINISH) == Z_STREAM_END;
        if (!put_part(png, error)) return NULL;
    }
    if (!put_chunk(png, "IEND", NULL, 0, error)) return NULL;
    uint8_t *file = png->file;
    *size = png->size;
    png->file = NULL;
    return file;
}
