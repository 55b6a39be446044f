/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The filtered rows of common PNG files: chunks are checked, then their pixels are decompressed. */
#include "base/base.h"
#include "pixels/internal.h"
#include "pixels/png.h"

#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

/* libpng refuses longer chunks where they are not pixels: MAX_TEXT_SIZE in png_read.c. */
enum { MAX_CHUNK = 1 << 16, IHDR_SIZE = 13, MAX_WINDOW_BITS = 15, HEADER_SIZE = 2, ADLER_SIZE = 4 };

static bool read_header(const PngChunk *chunk, PngLayout *layout, int64_t max_pixels) {
    const uint8_t *data = chunk->data;
    if (!png_chunk_is(chunk, "IHDR") || chunk->length != IHDR_SIZE) return false;
    *layout =
        (PngLayout){.width = png_number(data), .height = png_number(data + 4), .color = data[9], .depth = data[8]};
    bool shallow = layout->depth == 1 || layout->depth == 2 || layout->depth == 4;
    bool known = layout->color <= PNG_RGB_ALPHA && png_channels[layout->color] > 0 &&
                 (layout->depth == 8 || (shallow && (layout->color == PNG_GREY || layout->color == PNG_PALETTE)));
    bool sized = layout->width > 0 && layout->height > 0 && layout->width <= INT32_MAX && layout->height <= INT32_MAX &&
                 (uint64_t)layout->width * layout->height <= (uint64_t)max_pixels;
    return known && sized && data[10] == 0 && data[11] == 0 && data[12] == 0;
}

static bool read_palette(const PngChunk *chunk, PngLayout *layout) {
    bool coloured = layout->color == PNG_RGB || layout->color == PNG_PALETTE || layout->color == PNG_RGB_ALPHA;
    size_t most = layout->color == PNG_PALETTE ? (size_t)1 << layout->depth : 256, count = chunk->length / 3;
    if (!coloured || layout->colors > 0 || layout->has_clear || count == 0 || count > most || chunk->length % 3 != 0)
        return false;
    layout->colors = (int)count;
    for (size_t i = 0; i < count; i++) {
        memcpy(layout->palette[i], chunk->data + 3 * i, 3);
        layout->palette[i][3] = 255;
    }
    return true;
}

/* Samples of 16 bits, here of at most 8. */
static bool read_clear_colour(const PngChunk *chunk, PngLayout *layout, size_t samples) {
    if (chunk->length != 2 * samples) return false;
    for (size_t i = 0; i < samples; i++) {
        layout->clear[i] = chunk->data[2 * i + 1];
        if (chunk->data[2 * i] != 0 || layout->clear[i] >> layout->depth != 0) return false;
    }
    return true;
}

static bool read_transparency(const PngChunk *chunk, PngLayout *layout) {
    if (layout->has_clear) return false;
    layout->has_clear = true;
    if (layout->color == PNG_GREY) return read_clear_colour(chunk, layout, 1);
    if (layout->color == PNG_RGB) return read_clear_colour(chunk, layout, 3);
    if (layout->color != PNG_PALETTE || chunk->length == 0 || chunk->length > (size_t)layout->colors) return false;
    for (size_t i = 0; i < chunk->length; i++) layout->palette[i][3] = chunk->data[i];
    return true;
}

/* What has been seen of a file. */
typedef struct Scan {
    bool pixels, pixels_ended, ended;
} Scan;

static bool scan_pixels(PngRows *rows, Scan *scan, const PngChunk *chunk, size_t at) {
    const PngLayout *layout = &rows->layout;
    if (scan->pixels_ended || (layout->color == PNG_PALETTE && layout->colors == 0)) return false;
    if (chunk->length > MAX_CHUNK && chunk->length > layout->height * (rows->bytes + 1)) return false;
    if (!scan->pixels) rows->first = rows->next = at;
    rows->compressed += chunk->length;
    return scan->pixels = true;
}

static bool scan_chunk(PngRows *rows, Scan *scan, const PngChunk *chunk, size_t at) {
    if (png_chunk_is(chunk, "IDAT")) return scan_pixels(rows, scan, chunk, at);
    scan->pixels_ended = scan->pixels;
    scan->ended = png_chunk_is(chunk, "IEND");
    if (scan->ended) return scan->pixels && chunk->length == 0;
    if (png_chunk_is(chunk, "PLTE")) return !scan->pixels && read_palette(chunk, &rows->layout);
    if (png_chunk_is(chunk, "tRNS")) return !scan->pixels && read_transparency(chunk, &rows->layout);
    bool critical = (chunk->type[0] & 0x20) == 0, animated = png_chunk_is(chunk, "acTL") && !scan->pixels;
    return !critical && !animated && chunk->length <= MAX_CHUNK;
}

static void size_rows(PngRows *rows) {
    int bits = png_channels[rows->layout.color] * rows->layout.depth;
    rows->bytes = ((size_t)rows->layout.width * (size_t)bits + 7) / 8;
    rows->step = (bits + 7) / 8;
}

static bool scan_file(PngRows *rows, int64_t max_pixels) {
    PngChunk chunk;
    Scan scan = {false, false, false};
    size_t at = PNG_SIGNATURE, next = at;
    if (!png_has_signature(rows->file, rows->size) || !png_chunk_next(rows->file, rows->size, &next, &chunk) ||
        !png_chunk_is_sound(&chunk) || !read_header(&chunk, &rows->layout, max_pixels))
        return false;
    size_rows(rows);
    for (at = next; !scan.ended && png_chunk_next(rows->file, rows->size, &next, &chunk); at = next)
        if (!png_chunk_is_sound(&chunk) || !scan_chunk(rows, &scan, &chunk, at)) return false;
    /* Before memory is allocated for pixels that the file cannot hold. */
    return scan.ended && rows->bytes < UINT32_MAX / 2 && png_rows_size(rows) / PNG_BEST_RATIO <= rows->compressed;
}

bool png_rows_open(PngRows *rows, const uint8_t *file, size_t size, int64_t max_pixels) {
    *rows = (PngRows){.file = file, .size = size, .sum = 1};
    return scan_file(rows, max_pixels);
}

void png_rows_close(PngRows *rows) {
    if (rows->started) inflateEnd(&rows->stream);
    rows->started = false;
    free(rows->row);
}

size_t png_rows_size(const PngRows *rows) { return (rows->bytes + 1) * rows->layout.height; }

/* The bytes of all IDAT chunks; malloc'ed. */
static uint8_t *join_chunks(const PngRows *rows) {
    uint8_t *joined = malloc(rows->compressed + 1), *to = joined;
    PngChunk chunk;
    for (size_t at = rows->first; joined != NULL && png_chunk_next(rows->file, rows->size, &at, &chunk);) {
        if (!png_chunk_is(&chunk, "IDAT")) break;
        memcpy(to, chunk.data, chunk.length);
        to += chunk.length;
    }
    return joined;
}

/* A stream that goes on behind its end, or is shorter or longer than the rows, is left to libpng. */
static bool inflate_whole(PngRows *rows, uint8_t *all) {
    size_t used = 0;
    uint8_t *joined = join_chunks(rows);
    struct libdeflate_decompressor *decompressor = libdeflate_alloc_decompressor();
    bool ok = joined != NULL && decompressor != NULL &&
              libdeflate_zlib_decompress_ex(decompressor, joined, rows->compressed, all, png_rows_size(rows), &used,
                                            NULL) == LIBDEFLATE_SUCCESS &&
              used == rows->compressed;
    if (decompressor != NULL) libdeflate_free_decompressor(decompressor);
    free(joined);
    rows->whole = all;
    return ok;
}

/* Gives the stream the next IDAT chunk. */
static bool feed(PngRows *rows) {
    PngChunk chunk;
    while (rows->stream.avail_in == 0) {
        if (!png_chunk_next(rows->file, rows->size, &rows->next, &chunk) || !png_chunk_is(&chunk, "IDAT")) return false;
        rows->stream.next_in = (z_const Bytef *)chunk.data;
        rows->stream.avail_in = (uInt)chunk.length;
    }
    return true;
}

static bool take_number(PngRows *rows, int bytes, uint32_t *value) {
    *value = 0;
    for (int i = 0; i < bytes; i++) {
        if (!feed(rows)) return false;
        *value = *value << 8 | *rows->stream.next_in++;
        rows->stream.avail_in--;
    }
    return true;
}

/* The header of RFC 1950. A window that is smaller than the picture is left to libpng, as it would matter how the stream
   is cut into calls. */
static bool check_header(const PngRows *rows, uint32_t header) {
    int window_bits = (int)(header >> 12) + 8;
    return (header >> 8 & 0x0F) == Z_DEFLATED && header % 31 == 0 && (header & 0x20) == 0 &&
           window_bits <= MAX_WINDOW_BITS &&
           (window_bits == MAX_WINDOW_BITS || png_rows_size(rows) >> window_bits == 0);
}

/* Decompressed at once, a picture goes through memory, which only pays where decompression takes longer. */
static bool fits_at_once(const PngRows *rows) {
    enum { CACHED = 16 << 20, DENSE = 25 };
    return png_rows_size(rows) <= CACHED && png_rows_size(rows) / DENSE <= rows->compressed;
}

bool png_rows_start(PngRows *rows, uint8_t *all) {
    uint32_t header;
    if (!take_number(rows, HEADER_SIZE, &header) || !check_header(rows, header)) return false;
    if (fits_at_once(rows)) return inflate_whole(rows, all);
    /* Without zlib's checksum, which takes as long as its decompression. */
    rows->started = inflateInit2(&rows->stream, -MAX_WINDOW_BITS) == Z_OK;
    rows->row = malloc(rows->bytes + 1);
    return rows->started && rows->row != NULL;
}

/* Fills next_out; false if the stream ends before, or is damaged. */
static bool inflate_all(PngRows *rows) {
    while (rows->stream.avail_out > 0) {
        if (rows->ended || !feed(rows)) return false;
        int status = inflate(&rows->stream, Z_NO_FLUSH);
        if (status != Z_OK && status != Z_STREAM_END) return false;
        rows->ended = status == Z_STREAM_END;
    }
    return true;
}

const uint8_t *png_rows_next(PngRows *rows) {
    if (rows->whole != NULL) {
        const uint8_t *row = rows->whole;
        rows->whole += rows->bytes + 1;
        return row;
    }
    rows->stream.next_out = rows->row;
    rows->stream.avail_out = (uInt)rows->bytes + 1;
    if (!inflate_all(rows)) return NULL;
    rows->sum = libdeflate_adler32(rows->sum, rows->row, rows->bytes + 1);
    return rows->row;
}

bool png_rows_end(PngRows *rows) {
    uint8_t extra;
    uint32_t sum;
    if (rows->whole != NULL) return true;
    rows->stream.next_out = &extra;
    rows->stream.avail_out = 1;
    if (inflate_all(rows) || !rows->ended) return false; /* more than the rows, or no end */
    return take_number(rows, ADLER_SIZE, &sum) && sum == rows->sum && rows->stream.avail_in == 0 && !feed(rows);
}
