/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The filtered rows of common PNG files: chunks are checked, then their pixels are decompressed. */
#include "base/base.h"
#include "pixels/pixels_internal.h"
#include "pixels/png.h"

#ifdef TWINBOX_ISAL
#include <isa-l/igzip_lib.h>
#endif
#include <stdlib.h>
#include <string.h>

enum { CHUNK_HEAD = 8, IHDR_SIZE = 13, MAX_WINDOW_BITS = 15, HEADER_SIZE = 2 };

static bool is_pixels(const uint8_t head[CHUNK_HEAD]) { return memcmp(head + 4, "IDAT", 4) == 0; }

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

static bool read_transparency(const PngChunk *chunk, PngLayout *layout) {
    if (layout->has_clear) return false;
    layout->has_clear = true;
    if (layout->color == PNG_PALETTE) {
        if (chunk->length == 0 || chunk->length > (size_t)layout->colors) return false;
        for (size_t i = 0; i < chunk->length; i++) layout->palette[i][3] = chunk->data[i];
        return true;
    }
    /* Samples of 16 bits, here of at most 8. */
    const size_t samples = layout->color == PNG_GREY ? 1 : layout->color == PNG_RGB ? 3 : 0;
    if (samples == 0 || chunk->length != 2 * samples) return false;
    for (size_t i = 0; i < samples; i++) {
        layout->clear[i] = chunk->data[2 * i + 1];
        if (chunk->data[2 * i] != 0 || layout->clear[i] >> layout->depth != 0) return false;
    }
    return true;
}

/* The checksum of a chunk of pixels, of which the head is read. */
static bool check_pixels(PngRows *rows, const uint8_t head[CHUNK_HEAD]) {
    const uint8_t *bytes;
    uint8_t wanted[4];
    uint32_t checksum = libdeflate_crc32(0, head + 4, 4);
    for (size_t count, left = png_number(head); left > 0; left -= count, rows->source.at += count) {
        if ((count = png_source_peek(&rows->source, left, &bytes)) == 0) return false;
        checksum = libdeflate_crc32(checksum, bytes, count);
        for (size_t i = 0; i < count && rows->compressed + i < HEADER_SIZE; i++)
            rows->zlib[rows->compressed + i] = bytes[i];
        rows->compressed += count;
    }
    return png_source_take(&rows->source, wanted, sizeof wanted) && checksum == png_number(wanted);
}

/* Room at the end of the rest; NULL: out of memory. */
static uint8_t *add_room(PngRows *rows, size_t size) {
    const size_t at = rows->rest_size, all = at + size;
    if (!array_reserve((void **)&rows->rest, &rows->rest_capacity, all, 1)) return NULL;
    rows->rest_size = all;
    return rows->rest + at;
}

/* The next chunk, which is kept, with its checksum checked. */
static bool keep_chunk(PngRows *rows, const uint8_t head[CHUNK_HEAD], PngChunk *chunk) {
    size_t at = rows->rest_size;
    const size_t length = png_number(head);
    if (length > rows->source.size) return false;
    uint8_t *room = add_room(rows, length + PNG_CHUNK_FRAME);
    if (room == NULL) return false;
    memcpy(room, head, CHUNK_HEAD);
    return png_source_take(&rows->source, room + CHUNK_HEAD, length + PNG_CHUNK_FRAME - CHUNK_HEAD) &&
           png_chunk_next(rows->rest, rows->rest_size, &at, chunk) && png_chunk_is_sound(chunk);
}

bool png_rows_open(PngRows *rows, int64_t max_pixels) {
    PngLayout *layout = &rows->layout;
    PngChunk chunk;
    uint8_t head[CHUNK_HEAD], *room = add_room(rows, PNG_SIGNATURE);
    if (room == NULL || !png_source_take(&rows->source, room, PNG_SIGNATURE) ||
        !png_has_signature(room, PNG_SIGNATURE) || !png_source_take(&rows->source, head, sizeof head) ||
        !keep_chunk(rows, head, &chunk) || !read_header(&chunk, layout, max_pixels))
        return false;
    const int bits = png_channels[layout->color] * layout->depth;
    rows->bytes = ((size_t)layout->width * (size_t)bits + 7) / 8;
    rows->step = (bits + 7) / 8;

    bool pixels = false, pixels_ended = false, ended = false;
    while (!ended) {
        if (!png_source_take(&rows->source, head, sizeof head)) return false;
        if (is_pixels(head)) {
            if (pixels_ended || (layout->color == PNG_PALETTE && layout->colors == 0)) return false;
            if (!pixels) {
                if ((room = add_room(rows, sizeof png_no_pixels)) == NULL) return false;
                memcpy(room, png_no_pixels, sizeof png_no_pixels);
            }
            pixels = true;
            if (!check_pixels(rows, head)) return false;
            continue;
        }
        if (!keep_chunk(rows, head, &chunk)) return false;
        pixels_ended = pixels;
        ended = png_chunk_is(&chunk, "IEND");
        if (ended) {
            if (!pixels || chunk.length > 0) return false;
        } else if (png_chunk_is(&chunk, "PLTE")) {
            if (pixels || !read_palette(&chunk, layout)) return false;
        } else if (png_chunk_is(&chunk, "tRNS")) {
            if (pixels || !read_transparency(&chunk, layout)) return false;
        } else if ((chunk.type[0] & 0x20) == 0 || (png_chunk_is(&chunk, "acTL") && !pixels))
            return false;
    }
    if (!png_source_end(&rows->source)) return false;

    /* Before memory is allocated for pixels that the file cannot hold. */
    if (rows->bytes >= UINT32_MAX / 2) return false;
    const size_t filtered = (rows->bytes + 1) * rows->layout.height;
    if (!png_can_hold(rows->compressed, (double)filtered)) return false;
    /* The header of RFC 1950. A window that is smaller than the picture is left to libpng, as it would matter how the
       stream is cut into calls. */
    const uint8_t *zlib = rows->zlib;
    const int window_bits = (zlib[0] >> 4) + 8;
    return (zlib[0] & 0x0F) == Z_DEFLATED && (zlib[0] << 8 | zlib[1]) % 31 == 0 && (zlib[1] & 0x20) == 0 &&
           window_bits <= MAX_WINDOW_BITS && (window_bits == MAX_WINDOW_BITS || filtered >> window_bits == 0);
}

typedef struct PngStream {
#ifdef TWINBOX_ISAL
    struct inflate_state z; /* its first members are named as zlib's */
#else
    z_stream z;
#endif
} PngStream;

#ifdef TWINBOX_ISAL
static bool stream_open(PngStream *stream, uint8_t header[HEADER_SIZE]) {
    (void)header;
    isal_inflate_init(&stream->z);
    stream->z.crc_flag = ISAL_ZLIB_NO_HDR_VER;
    return true;
}

static void stream_close(PngStream *stream) { (void)stream; }

static bool stream_copy(PngStream *to, PngStream *from) {
    *to = *from;
    return true;
}

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

static bool stream_copy(PngStream *to, PngStream *from) {
    (void)inflateEnd(&to->z);
    return inflateCopy(&to->z, &from->z) == Z_OK;
}

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
    free(rows->rest);
    png_source_close(&rows->source);
}

/* The next compressed bytes; 0: there are no more. */
static size_t peek_pixels(PngRows *rows, const uint8_t **bytes) {
    uint8_t head[CHUNK_HEAD];
    while (rows->pixels == 0 && !rows->outside) {
        rows->outside = !png_source_take(&rows->source, NULL, rows->skipped) ||
                        !png_source_take(&rows->source, head, sizeof head) || (rows->inside && !is_pixels(head));
        if (rows->outside) break;
        rows->inside = is_pixels(head);
        rows->pixels = rows->inside ? png_number(head) : 0;
        rows->skipped = PNG_CHUNK_FRAME - CHUNK_HEAD + (rows->inside ? 0 : (size_t)png_number(head));
    }
    return rows->pixels == 0 ? 0 : png_source_peek(&rows->source, rows->pixels, bytes);
}

static void pass_pixels(PngRows *rows, size_t count) {
    rows->source.at += count;
    rows->pixels -= count;
}

/* Gives the stream the next compressed bytes, with a twin those that both have. From where the twin's are others, it
   decompresses for itself. */
static bool feed(PngRows *rows) {
    const uint8_t *bytes = NULL, *other = NULL;
    if (rows->stream->z.avail_in > 0) return true;
    size_t count = peek_pixels(rows, &bytes);
    if (rows->twin != NULL) {
        PngRows *twin = rows->twin;
        const size_t others = peek_pixels(twin, &other), most = count < others ? count : others;
        size_t same = most > 0 && memcmp(bytes, other, most) == 0 ? most : 0;
        if (same == 0)
            while (same < most && bytes[same] == other[same]) same++;
        if (same > 0)
            pass_pixels(twin, count = same);
        else {
            rows->twin = NULL;
            twin->started = stream_copy(twin->stream, rows->stream);
            twin->ended = rows->ended;
        }
    }
    rows->stream->z.next_in = (uint8_t *)bytes; /* not changed */
    rows->stream->z.avail_in = (uint32_t)count;
    pass_pixels(rows, count);
    return count > 0;
}

bool png_rows_start(PngRows *rows) {
    const uint8_t *bytes;
    if ((rows->stream = calloc(1, sizeof *rows->stream)) == NULL || !png_source_rewind(&rows->source)) return false;
    rows->skipped = PNG_SIGNATURE;
    for (int i = 0; i < HEADER_SIZE; i++) {
        if (peek_pixels(rows, &bytes) == 0) return false;
        pass_pixels(rows, 1);
    }
    return rows->started = stream_open(rows->stream, rows->zlib);
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

bool png_rows_read_parted(PngRows *rows, const uint8_t *from, uint8_t *to, size_t size) {
    const size_t left = rows->stream->z.avail_out;
    memcpy(to, from, size - left);
    return png_rows_read(rows, to + size - left, left);
}

bool png_rows_end(PngRows *rows) {
    uint8_t extra;
    const bool more = png_rows_read(rows, &extra, 1);
    while (rows->twin != NULL && !more) { /* the padding behind the stream, until the files part */
        rows->stream->z.avail_in = 0;
        (void)feed(rows);
    }
    rows->damaged = more || !rows->ended || !png_source_end(&rows->source);
    return !rows->damaged;
}
