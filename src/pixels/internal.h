/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of this room: shaders, damage, chunks and filters of PNG files. */
#pragma once
#include "base/base.h"
#include "pixels/gl.h"
#include "pixels/png.h"
#include "pixels/type.h"

#include <png.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <zlib.h>

/* The GLSL of shaders/, embedded in the binary by tools/embed.cmake. */

extern const char shader_rect_vert[], shader_rect_frag[];
extern const char shader_shape_vert[], shader_shape_frag[];
extern const char shader_text_vert[], shader_text_frag[];

/* Bitmaps of glyphs that are not in the atlas, drawn from their outlines when text needs them. */

/* The size and place of a glyph at `pixels` per em; its offset is 0. */
FontGlyph glyph_metrics(const Typeface *face, const Glyph *glyph, int pixels);

/* Fills the glyph's bitmap in the levels of the atlas; false if out of memory. */
bool glyph_draw(const Typeface *face, const Glyph *glyph, int pixels, const FontGlyph *metrics, uint8_t *bitmap);

/* A deflate stream of one block with a constant dynamic code (RFC 1951, 3.2.7), tuned for the rows of flat pictures,
   most of which equal the row above. With a constant code, the bits of a row depend only on that row. */

enum {
    DEFLATE_RUN = 86,           /* pixels of three bytes that one match can repeat: 258 / 3 */
    DEFLATE_LITERAL_BITS = 10,  /* longest code */
    DEFLATE_HEADER_BYTES = 176, /* upper bound of what deflate_begin() writes */
    BITS_MARGIN = 8             /* bytes that a BitWriter may write past its last bit */
};

/* Writes bits from the lowest up, as deflate packs them. */
typedef struct BitWriter {
    uint8_t *next;
    uint64_t pending; /* fewer than 8 bits */
    unsigned count;   /* of pending bits */
} BitWriter;

/* Writes up to 56 bits. Stores eight bytes (compilers emit one store) and advances by the complete ones. */
static inline void bits_write(BitWriter *writer, uint64_t bits, unsigned count) {
    uint8_t *next = writer->next;
    bits = writer->pending | bits << writer->count;
    count += writer->count;
    for (int i = 0; i < 8; i++) next[i] = (uint8_t)(bits >> (8 * i));
    writer->next = next + count / 8;
    writer->pending = bits >> (count & ~7u);
    writer->count = count % 8;
}

/* Completes the last byte with zeros. */
static inline void bits_end(BitWriter *writer) {
    if (writer->count > 0) *writer->next++ = (uint8_t)writer->pending;
    writer->pending = writer->count = 0;
}

typedef struct DeflateCode {
    uint32_t bits, count;
} DeflateCode;

typedef struct DeflateCodes {
    DeflateCode literals[256], end;
    DeflateCode runs[DEFLATE_RUN + 1]; /* [n], n >= 1: repeats the last three bytes n times */
} DeflateCodes;

void deflate_make_codes(DeflateCodes *codes);

/* Writes the header of a zlib stream (RFC 1950) and of its only block. */
void deflate_begin(BitWriter *writer);

/* Memory for libpng, and for zlib below it. They report a lack of memory as damage of the file, or only warn and skip a
   text; these functions, with a bool as their mem_ptr, set it. */

png_voidp png_memory_take(png_structp png, png_alloc_size_t size);
void png_memory_release(png_structp png, png_voidp block);

/* The row filters of PNG (specification, section 9). */

/* row[bytes] = the row that `filtered`, a filter's number and `bytes` bytes, stands for. above[bytes]: the row above,
   zeros for the first. step: 1 to 4, bytes per pixel. No two of the arrays overlap. False for an unknown filter. */
bool png_unfilter(const uint8_t *filtered, const uint8_t *above, size_t bytes, int step, uint8_t *row);

/* Reads common PNG files row by row, several times as fast as libpng: at most 8 bits per sample, not interlaced, nothing
   unusual. A function that returns false leaves the file to libpng, which decides whether it is damaged; so only what
   libpng would read, and as it would, may be accepted. */

enum { PNG_GREY = 0, PNG_RGB = 2, PNG_PALETTE = 3, PNG_GREY_ALPHA = 4, PNG_RGB_ALPHA = 6 };

/* What the bytes of a row mean. */
typedef struct PngLayout {
    uint32_t width, height;
    int color, depth;
    int colors;              /* of the palette */
    uint8_t palette[256][4]; /* RGBA */
    bool has_clear;          /* one colour is transparent: */
    uint8_t clear[3];        /* the samples of RGB, or the first of GREY */
} PngLayout;

typedef struct PngRows {
    PngLayout layout;
    size_t bytes; /* of an unfiltered row */
    int step;     /* bytes per pixel, at least 1 */
    const uint8_t *file;
    size_t size, first, next; /* positions of the first IDAT chunk and of the one to read */
    size_t compressed;        /* bytes of all IDAT chunks */
    const uint8_t *whole;     /* the next row of a picture that is decompressed at once; NULL: by zlib, row by row: */
    z_stream stream;
    bool started, ended;
    uint32_t sum; /* Adler-32 of all rows so far */
    uint8_t *row; /* [1 + bytes] */
} PngRows;

/* Checks all chunks and their checksums, and refuses animations. png_rows_close() must follow. */
bool png_rows_open(PngRows *rows, const uint8_t *file, size_t size, int64_t max_pixels);
void png_rows_close(PngRows *rows);

/* Bytes of all filtered rows. */
size_t png_rows_size(const PngRows *rows);

/* Begins to decompress: at once by libdeflate, into all[png_rows_size()]; or row by row by zlib, where the picture is large
   or shrinks to so little that memory is slower than zlib. */
bool png_rows_start(PngRows *rows, uint8_t *all);

/* The next row as it is stored, [1 + bytes], see pixels/internal.h; NULL: as false. */
const uint8_t *png_rows_next(PngRows *rows);

/* Whether the file ends with its last row, and the checksum of its rows is right. */
bool png_rows_end(PngRows *rows);

/* rgba[4 * width] for a row. False if a colour is not in the palette. */
bool png_expand(const PngLayout *layout, const uint8_t *row, uint8_t *rgba);

bool png_same_layout(const PngLayout *a, const PngLayout *b);

/* Decodes common PNG files. False: nothing is decoded, and libpng has to. */

bool png_fast_decode(const uint8_t *data, size_t size, int64_t max_pixels, Image **image);

/* Two files with the same layout, row by row: images[1] is images[0] if all pixels are equal. */
bool png_fast_decode_pair(const uint8_t *const data[2], const size_t sizes[2], int64_t max_pixels, Image *images[2]);

/* Any file, by libpng; NULL with error set. What png_fast_decode() accepts, this accepts, with the same pixels. */
Image *png_libpng_decode(const uint8_t *data, size_t size, const char *path, int64_t max_pixels, Error *error);

/* Compressed pixels of PNG files (IDAT), optimised for frames of a sequence: flat colours, most rows equal to the
   row above and to that of the previous frame. Correct for every picture, but noise grows. The bytes depend only on
   the pixels. */

typedef struct Idat Idat;

/* For 8-bit RGB pictures of this size. */
Idat *idat_create(int width, int height, Error *error);
void idat_destroy(Idat *idat);

/* Compresses an image without its alpha. `changed` flags the rows that may differ from the previous image; NULL:
   all. *data is valid until the next call. After an error (out of memory), pass NULL in the next call. */
bool idat_encode(Idat *idat, const Image *image, const bool *changed, const uint8_t **data, size_t *size, Error *error);
