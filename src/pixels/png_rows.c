/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The filtered rows of common PNG files: chunks are checked, then their pixels are decompressed. */
#include "base/base.h"
#include "pixels/internal.h"
#include "pixels/png.h"

#ifdef TWINBOX_ISAL
#include <isa-l/igzip_lib.h>
#endif
#include <stdlib.h>
#include <string.h>

/* libpng refuses longer chunks where they are not pixels: MAX_TEXT_SIZE in png_read.c. */
enum { MAX_CHUNK = 1 << 16, IHDR_SIZE = 13, MAX_WINDOW_BITS = 15, HEADER_SIZE = 2 };

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
    *rows = (PngRows){.file = file, .size = size};
    return scan_file(rows, max_pixels);
}

size_t png_rows_size(const PngRows *rows) { return (rows->bytes + 1) * rows->layout.height; }

typedef struct PngStream {
#ifdef TWINBOX_ISAL
    struct inflate_state z; /* its first members are named as zlib's */
#else
    z_stream z;
#endif
} PngStream;

/* Gives the stream the next IDAT chunk; the chunk behind them is never passed. */
static bool feed(PngRows *rows) {
    PngChunk chunk;
    while (rows->stream->z.avail_in == 0) {
        size_t next = rows->next;
        if (!png_chunk_next(rows->file, rows->size, &next, &chunk) || !png_chunk_is(&chunk, "IDAT")) return false;
        rows->next = next;
        rows->stream->z.next_in = (uint8_t *)chunk.data; /* not changed */
        rows->stream->z.avail_in = (uint32_t)chunk.length;
    }
    return true;
}

/* The header of RFC 1950. A window that is smaller than the picture is left to libpng, as it would matter how the stream
   is cut into calls. */
static bool check_header(const PngRows *rows, const uint8_t header[HEADER_SIZE]) {
    int window_bits = (header[0] >> 4) + 8;
    return (header[0] & 0x0F) == Z_DEFLATED && (header[0] << 8 | header[1]) % 31 == 0 && (header[1] & 0x20) == 0 &&
           window_bits <= MAX_WINDOW_BITS &&
           (window_bits == MAX_WINDOW_BITS || png_rows_size(rows) >> window_bits == 0);
}

#ifdef TWINBOX_ISAL
static bool stream_open(PngStream *stream, uint8_t header[HEADER_SIZE]) {
    (void)header;
    isal_inflate_init(&stream->z);
    stream->z.crc_flag = ISAL_ZLIB_NO_HDR_VER;
    return true;
}

static void stream_close(PngStream *stream) { (void)stream; }

static bool stream_run(PngStream *stream, bool *ended) {
    const int status = isal_inflate(&stream->z);
    *ended = status == ISAL_DECOMP_OK && stream->z.block_state == ISAL_BLOCK_FINISH;
    return status == ISAL_DECOMP_OK;
}

static bool has_left(const PngStream *stream) { return stream->z.avail_in > 0 || stream->z.read_in_length >= 8; }
#else
static bool stream_open(PngStream *stream, uint8_t header[HEADER_SIZE]) {
    if (inflateInit2(&stream->z, MAX_WINDOW_BITS) != Z_OK) return false;
    stream->z.next_in = header, stream->z.avail_in = HEADER_SIZE;
    stream->z.next_out = header; /* nothing is written */
    (void)inflate(&stream->z, Z_NO_FLUSH);
    return stream->z.avail_in == 0;
}

static void stream_close(PngStream *stream) { (void)inflateEnd(&stream->z); }

static bool stream_run(PngStream *stream, bool *ended) {
    const int status = inflate(&stream->z, Z_NO_FLUSH);
    *ended = status == Z_STREAM_END;
    return status == Z_OK || status == Z_STREAM_END || status == Z_BUF_ERROR;
}

static bool has_left(const PngStream *stream) { return stream->z.avail_in > 0; }
#endif

void png_rows_close(PngRows *rows) {
    if (rows->started) stream_close(rows->stream);
    free(rows->stream);
}

bool png_rows_start(PngRows *rows) {
    uint8_t header[HEADER_SIZE];
    PngStream *stream = rows->stream = calloc(1, sizeof *rows->stream);
    for (int i = 0; i < HEADER_SIZE; i++) {
        if (stream == NULL || !feed(rows)) return false;
        header[i] = *stream->z.next_in++;
        stream->z.avail_in--;
    }
    if (!check_header(rows, header)) return false;
    uint8_t *const next = stream->z.next_in;
    const uint32_t left = stream->z.avail_in;
    rows->started = stream_open(stream, header);
    stream->z.next_in = next, stream->z.avail_in = left;
    return rows->started;
}

bool png_rows_read(PngRows *rows, uint8_t *to, size_t size) {
    rows->stream->z.next_out = to;
    rows->stream->z.avail_out = (uint32_t)size;
    while (rows->stream->z.avail_out > 0) {
        const uint32_t room = rows->stream->z.avail_out;
        if (rows->ended) return false;
        const bool more = feed(rows);
        if ((!more && !has_left(rows->stream)) || !stream_run(rows->stream, &rows->ended)) return false;
        if (!more && rows->stream->z.avail_out == room) return false; /* it waits for bytes that are missing */
    }
    return true;
}

bool png_rows_end(PngRows *rows) {
    uint8_t extra;
    if (png_rows_read(rows, &extra, 1) || !rows->ended) return false; /* more than the rows, or no end */
    return !has_left(rows->stream) && !feed(rows);
}
