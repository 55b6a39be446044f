/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Each row goes through the Up filter: pixels that equal those above become zero. Then each run of equal pixels
   becomes one pixel and matches that repeat it. The bits of a row are kept, and its part of the checksum, which is
   computed per run: a row is compressed again only if it or the row above has changed. */
#include "base/base.h"
#include "pixels/internal.h"
#include "pixels/png.h"

#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

enum { FILTER_UP = 2, CHANNELS = 3, WORD_BYTES = 8, CHUNK_BITS = 56 };
static const uint64_t ADLER_MODULUS = 65521;

/* The bits, and the row's part of Adler-32: the sum of its bytes, and the sum weighted by the distance from the
   row's end. */
typedef struct Row {
    uint8_t *bits;
    size_t capacity, count;
    uint64_t sum, weighted;
} Row;

struct Idat {
    int width, height;
    DeflateCodes codes;
    uint32_t *differences; /* [width], of a row to the one above, RGBA */
    uint8_t *edges;        /* [width + 1], 1 where a run begins; padded by a word */
    uint8_t *scratch;      /* buffer for the largest row */
    uint8_t *blank;        /* a row of zeros, above the first row */
    Row *rows;             /* [height] */
    uint8_t *data;
    size_t capacity;
};

static size_t max_row_bytes(int width) {
    return ((size_t)width * CHANNELS + 1) * DEFLATE_LITERAL_BITS / 8 + 1 + BITS_MARGIN;
}

Idat *idat_create(int width, int height, Error *error) {
    Idat *idat = calloc(1, sizeof *idat);
    if (idat != NULL) {
        *idat = (Idat){.width = width, .height = height};
        idat->differences = malloc((size_t)width * sizeof *idat->differences);
        idat->edges = calloc((size_t)width + 1 + WORD_BYTES, 1);
        idat->scratch = malloc(max_row_bytes(width));
        idat->blank = calloc((size_t)width, 4);
        idat->rows = calloc((size_t)height, sizeof *idat->rows);
        deflate_make_codes(&idat->codes);
    }
    if (idat != NULL && idat->differences != NULL && idat->edges != NULL && idat->scratch != NULL &&
        idat->blank != NULL && idat->rows != NULL)
        return idat;
    idat_destroy(idat);
    error_memory(error, "image");
    return NULL;
}

void idat_destroy(Idat *idat) {
    if (idat == NULL) return;
    for (int y = 0; idat->rows != NULL && y < idat->height; y++) free(idat->rows[y].bits);
    free(idat->differences);
    free(idat->edges);
    free(idat->scratch);
    free(idat->blank);
    free(idat->rows);
    free(idat->data);
    free(idat);
}

/* The difference of a row to the one above, per byte modulo 256, and the pixels that differ from their left
   neighbour. Simple loops that compilers vectorise: for the baseline instruction set here, for AVX2 below. */
static inline void subtract(uint8_t *differences, const uint8_t *row, const uint8_t *above, int width) {
    for (int i = 0; i < 4 * width; i++) differences[i] = (uint8_t)(row[i] - above[i]);
}

static inline void find_edges(uint8_t *edges, const uint32_t *pixels, int width) {
    static const uint8_t without_alpha[4] = {255, 255, 255, 0};
    uint32_t mask;
    memcpy(&mask, without_alpha, sizeof mask);
    for (int i = 1; i < width; i++) edges[i] = ((pixels[i] ^ pixels[i - 1]) & mask) != 0;
}

static void compare_rows_baseline(Idat *idat, const uint8_t *row, const uint8_t *above) {
    subtract((uint8_t *)idat->differences, row, above, idat->width);
    find_edges(idat->edges, idat->differences, idat->width);
}

#ifdef TWINBOX_AVX
__attribute__((target("avx2"), flatten)) static void compare_rows_avx2(Idat *idat, const uint8_t *row,
                                                                       const uint8_t *above) {
    subtract((uint8_t *)idat->differences, row, above, idat->width);
    find_edges(idat->edges, idat->differences, idat->width);
}
#endif

static void compare_rows(Idat *idat, const uint8_t *row, const uint8_t *above) {
    idat->edges[idat->width] = 1; /* the last run ends with the row */
#ifdef TWINBOX_AVX
    if (__builtin_cpu_supports("avx2")) {
        compare_rows_avx2(idat, row, above);
        return;
    }
#endif
    compare_rows_baseline(idat, row, above);
}

/* Compilers emit one load. */
static uint64_t load_word(const uint8_t *bytes) {
    uint64_t word = 0;
    for (int i = 0; i < WORD_BYTES; i++) word |= (uint64_t)bytes[i] << (8 * i);
    return word;
}

/* Most runs are short: test the next eight edges with one word. */
static int run_length(const uint8_t *edges, int remaining) {
    uint64_t word = load_word(edges + 1);
    if (word != 0) return 1 + __builtin_ctzll(word) / 8;
    return (int)((const uint8_t *)memchr(edges + 1, 1, (size_t)remaining) - edges);
}

static void write_code(BitWriter *writer, DeflateCode code) { bits_write(writer, code.bits, code.count); }

static void write_run(BitWriter *writer, const DeflateCodes *codes, const uint8_t pixel[CHANNELS], int length) {
    DeflateCode a = codes->literals[pixel[0]], b = codes->literals[pixel[1]], c = codes->literals[pixel[2]];
    bits_write(writer, a.bits | (uint64_t)b.bits << a.count | (uint64_t)c.bits << (a.count + b.count),
               a.count + b.count + c.count);
    for (length--; length > DEFLATE_RUN; length -= DEFLATE_RUN) write_code(writer, codes->runs[DEFLATE_RUN]);
    write_code(writer, codes->runs[length]);
}

/* Adds a run to the row's sums. `remaining`: pixels from the run's first to the row's end. The pixels' first bytes
   have the distances 3 * remaining, 3 * (remaining - 1), ... from the end; second and third bytes one and two less. */
static void add_run(Row *row, const uint8_t pixel[CHANNELS], int length, int remaining) {
    uint64_t n = (uint64_t)length, bytes = (uint64_t)pixel[0] + pixel[1] + pixel[2];
    uint64_t places = CHANNELS * (n * (uint64_t)remaining - n * (n - 1) / 2);
    row->sum += n * bytes;
    row->weighted += bytes * places - n * (pixel[1] + 2u * pixel[2]);
}

static bool keep_bits(Row *row, const uint8_t *bits, const BitWriter *end, Error *error) {
    BitWriter writer = *end;
    size_t count = (size_t)(writer.next - bits) * 8 + writer.count;
    bits_end(&writer);
    size_t bytes = (size_t)(writer.next - bits);
    /* write_row() reads whole words. */
    if (!array_reserve((void **)&row->bits, &row->capacity, bytes + WORD_BYTES, 1)) return error_memory(error, "image");
    memcpy(row->bits, bits, bytes);
    row->count = count;
    return true;
}

static bool encode_row(Idat *idat, const uint8_t *pixels, const uint8_t *above, Row *row, Error *error) {
    BitWriter writer = {.next = idat->scratch};
    write_code(&writer, idat->codes.literals[FILTER_UP]);
    row->sum = FILTER_UP;
    row->weighted = FILTER_UP * ((uint64_t)idat->width * CHANNELS + 1);
    if (memcmp(pixels, above, 4 * (size_t)idat->width) == 0) {
        write_run(&writer, &idat->codes, idat->blank, idat->width);
        return keep_bits(row, idat->scratch, &writer, error);
    }
    compare_rows(idat, pixels, above);
    const uint8_t *differences = (const uint8_t *)idat->differences;
    for (int x = 0, length; x < idat->width; x += length) {
        length = run_length(idat->edges + x, idat->width - x);
        write_run(&writer, &idat->codes, differences + 4 * x, length);
        add_run(row, differences + 4 * x, length, idat->width - x);
    }
    return keep_bits(row, idat->scratch, &writer, error);
}

static bool encode_rows(Idat *idat, const Image *image, const bool *changed, Error *error) {
    size_t stride = (size_t)idat->width * 4;
    const uint8_t *pixels = image->pixels, *above = idat->blank;
    for (int y = 0; y < idat->height; y++, above = pixels, pixels += stride) {
        bool kept = changed != NULL && !changed[y] && (y == 0 || !changed[y - 1]);
        if (!kept && !encode_row(idat, pixels, above, &idat->rows[y], error)) return false;
    }
    return true;
}

static void write_row(BitWriter *writer, const Row *row) {
    size_t at = 0;
    for (; at + CHUNK_BITS <= row->count; at += CHUNK_BITS)
        bits_write(writer, load_word(row->bits + at / 8) & (((uint64_t)1 << CHUNK_BITS) - 1), CHUNK_BITS);
    unsigned left = (unsigned)(row->count - at);
    bits_write(writer, load_word(row->bits + at / 8) & (((uint64_t)1 << left) - 1), left);
}

/* Adler-32 (RFC 1950): over a row, b grows by the old a once per byte. */
static uint32_t checksum(const Idat *idat) {
    uint64_t a = 1, b = 0, bytes = (uint64_t)idat->width * CHANNELS + 1;
    for (int y = 0; y < idat->height; y++) {
        const Row *row = &idat->rows[y];
        b = (b + bytes * a + row->weighted) % ADLER_MODULUS;
        a = (a + row->sum) % ADLER_MODULUS;
    }
    return (uint32_t)(b << 16 | a);
}

static size_t joined_size(const Idat *idat) {
    size_t bits = 0;
    for (int y = 0; y < idat->height; y++) bits += idat->rows[y].count;
    return DEFLATE_HEADER_BYTES + bits / 8 + BITS_MARGIN + 16; /* end of block and checksum */
}

bool idat_encode(Idat *idat, const Image *image, const bool *changed, const uint8_t **data, size_t *size,
                 Error *error) {
    if (!encode_rows(idat, image, changed, error)) return false;
    if (!array_reserve((void **)&idat->data, &idat->capacity, joined_size(idat), 1))
        return error_memory(error, "image");
    BitWriter writer = {.next = idat->data};
    deflate_begin(&writer);
    for (int y = 0; y < idat->height; y++) write_row(&writer, &idat->rows[y]);
    write_code(&writer, idat->codes.end);
    bits_end(&writer);
    uint32_t sum = checksum(idat);
    for (int shift = 24; shift >= 0; shift -= 8) *writer.next++ = (uint8_t)(sum >> shift);
    *data = idat->data;
    *size = (size_t)(writer.next - idat->data);
    return true;
}

/* libpng refuses longer chunks where they are not pixels: MAX_TEXT_SIZE in png_read.c. */
enum { MAX_CHUNK = 1 << 16, IHDR_SIZE = 13, MAX_WINDOW_BITS = 15, HEADER_SIZE = 2, ADLER_SIZE = 4 };

enum { DEFLATE_BEST_RATIO = 1032 }; /* two bits for 258 bytes (RFC 1951, 3.2.5) */

static bool read_header(const PngChunk *chunk, PngLayout *layout, int64_t max_pixels) {
    static const int channels[] = {
        [PNG_GREY] = 1, [PNG_RGB] = 3, [PNG_PALETTE] = 1, [PNG_GREY_ALPHA] = 2, [PNG_RGB_ALPHA] = 4};
    const uint8_t *data = chunk->data;
    if (!png_chunk_is(chunk, "IHDR") || chunk->length != IHDR_SIZE) return false;
    *layout =
        (PngLayout){.width = png_number(data), .height = png_number(data + 4), .color = data[9], .depth = data[8]};
    bool shallow = layout->depth == 1 || layout->depth == 2 || layout->depth == 4;
    bool known = layout->color <= PNG_RGB_ALPHA && channels[layout->color] > 0 &&
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

static bool is_sound(const PngChunk *chunk) {
    for (int i = 0; i < 4; i++) {
        uint8_t letter = chunk->type[i] & 0xDF;
        if (letter < 'A' || letter > 'Z') return false;
    }
    return libdeflate_crc32(0, chunk->type, chunk->length + 4) == png_number(chunk->data + chunk->length);
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
    static const int channels[] = {
        [PNG_GREY] = 1, [PNG_RGB] = 3, [PNG_PALETTE] = 1, [PNG_GREY_ALPHA] = 2, [PNG_RGB_ALPHA] = 4};
    int bits = channels[rows->layout.color] * rows->layout.depth;
    rows->bytes = ((size_t)rows->layout.width * (size_t)bits + 7) / 8;
    rows->step = (bits + 7) / 8;
}

static bool scan_file(PngRows *rows, int64_t max_pixels) {
    static const uint8_t signature[PNG_SIGNATURE] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    PngChunk chunk;
    Scan scan = {false, false, false};
    size_t at = PNG_SIGNATURE, next = at;
    if (rows->size < PNG_SIGNATURE || memcmp(rows->file, signature, PNG_SIGNATURE) != 0 ||
        !png_chunk_next(rows->file, rows->size, &next, &chunk) || !is_sound(&chunk) ||
        !read_header(&chunk, &rows->layout, max_pixels))
        return false;
    size_rows(rows);
    for (at = next; !scan.ended && png_chunk_next(rows->file, rows->size, &next, &chunk); at = next)
        if (!is_sound(&chunk) || !scan_chunk(rows, &scan, &chunk, at)) return false;
    /* Before memory is allocated for pixels that the file cannot hold. */
    return scan.ended && rows->bytes < UINT32_MAX / 2 && png_rows_size(rows) / DEFLATE_BEST_RATIO <= rows->compressed;
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
