/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The parts of this room: PNG files, glyphs, shaders. */
#pragma once
#include "base/base.h"
#include "pixels/gl.h"
#include "pixels/png.h"
#include "pixels/type.h"

#include <libdeflate.h>
#include <png.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <zlib.h>

/* What all that reads or writes PNG files knows (specification). */

static const uint8_t png_signature[PNG_SIGNATURE] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
enum { PNG_GREY = 0, PNG_RGB = 2, PNG_PALETTE = 3, PNG_GREY_ALPHA = 4, PNG_RGB_ALPHA = 6 };

/* An empty chunk of pixels. */
static const uint8_t png_no_pixels[PNG_CHUNK_FRAME] = {0, 0, 0, 0, 'I', 'D', 'A', 'T', 0x35, 0xAF, 0x06, 0x1E};

static const int png_channels[] = {
    [PNG_GREY] = 1, [PNG_RGB] = 3, [PNG_PALETTE] = 1, [PNG_GREY_ALPHA] = 2, [PNG_RGB_ALPHA] = 4};
enum { PNG_BEST_RATIO = 1032 }; /* deflate shrinks 258 bytes to no less than two bits (RFC 1951, 3.2.5) */

static inline bool png_has_signature(const uint8_t *data, size_t size) {
    return size >= PNG_SIGNATURE && memcmp(data, png_signature, PNG_SIGNATURE) == 0;
}

/* Four letters, the third a capital, as in all names today (PNG 5.4). Whether libpng accepts others depends on its
   version. */
static inline bool png_chunk_has_name(const PngChunk *chunk) {
    for (int i = 0; i < 4; i++) {
        const uint8_t letter = i == 2 ? chunk->type[i] : chunk->type[i] & 0xDF;
        if (letter < 'A' || letter > 'Z') return false;
    }
    return true;
}

/* Whether so many compressed bytes can hold these filtered rows. */
static inline bool png_can_hold(uint64_t compressed, double rows) {
    const double frame = 6; /* the zlib header and the checksum */
    return (double)compressed >= frame + rows / PNG_BEST_RATIO;
}

/* Whether it has a name and the right checksum. */
static inline bool png_chunk_is_sound(const PngChunk *chunk) {
    return png_chunk_has_name(chunk) &&
           libdeflate_crc32(0, chunk->type, chunk->length + 4) == png_number(chunk->data + chunk->length);
}

/* The bytes of a file, from its start to its end, as often as they are needed: from memory, or in pieces. Of a file
   that is read in pieces, each pass must have the same hash: then what was compared is what has this hash. */

static const size_t PNG_MAX_FILE_SIZE = (size_t)1 << 30; /* IMAGE_MAX_PIXELS of 16 bits, uncompressed, need less */

typedef struct PngSource {
    int file;                /* -1: `data` is the whole file */
    size_t size;             /* of the file */
    const uint8_t *data;     /* the piece in work */
    size_t held, at, left;   /* its bytes; the next one; bytes of the file behind the piece */
    uint8_t *piece;          /* memory for it */
    struct HashParts *parts; /* of this pass */
    uint64_t hash;           /* XXH3 of the file, after a pass */
    bool hashed;
} PngSource;

void png_source_of(PngSource *source, const uint8_t *data, size_t size);

void png_source_close(PngSource *source);

/* Begins a pass. The first has begun. */
bool png_source_rewind(PngSource *source);

/* The next bytes, at least one and at most `most`, which last until the next call; 0: there are none, or reading
   failed. Those that are used are added to source->at. */
size_t png_source_peek(PngSource *source, size_t most, const uint8_t **bytes);

/* Copies the next bytes; to NULL: passes over them. False if there are less. */
bool png_source_take(PngSource *source, uint8_t *to, size_t size);

/* Reads what is left of the pass. False if the file has changed. */
bool png_source_end(PngSource *source);

/* Reads common PNG files row by row, several times as fast as libpng: at most 8 bits per sample, not interlaced,
   nothing unusual. A function that returns false leaves the file to libpng, which decides whether it is damaged; so
   only what libpng would read, and as it would, may be accepted. */

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
    PngSource source;
    PngLayout layout;
    size_t bytes;      /* of an unfiltered row */
    int step;          /* bytes per pixel, at least 1 */
    size_t compressed; /* bytes of all IDAT chunks */
    uint8_t zlib[2];   /* the first of these */
    uint8_t *rest;     /* [rest_size] the file with one empty IDAT chunk in place of these */
    size_t rest_size, rest_capacity;
    size_t pixels, skipped;   /* while rows are read: bytes of the IDAT chunk, and then up to the next chunk */
    bool inside, outside;     /* an IDAT chunk has begun; the last has ended */
    struct PngStream *stream; /* ISA-L's or zlib's */
    struct PngRows *twin;     /* another file whose compressed bytes have been the same so far, or NULL */
    bool started, ended;
    bool damaged; /* its rows cannot be read */
} PngRows;

/* Of a file whose source is set: checks all chunks and their checksums, and refuses animations. png_rows_close(), which
   closes the source, must follow. */
bool png_rows_open(PngRows *rows, int64_t max_pixels);
void png_rows_close(PngRows *rows);

/* Begins to decompress. */
bool png_rows_start(PngRows *rows);

/* The next `size` bytes of the rows as they are stored: of each a filter and its bytes. Those of a twin are the same,
   up to where the compressed bytes of both files part: then rows->twin becomes NULL. */
bool png_rows_read(PngRows *rows, uint8_t *to, size_t size);

/* The same bytes for one that was the twin of what has read `from`. */
bool png_rows_read_parted(PngRows *rows, const uint8_t *from, uint8_t *to, size_t size);

/* Whether the file ends with its last row, and the checksum of its rows is right. */
bool png_rows_end(PngRows *rows);

/* Decodes common PNG files. False: nothing is decoded, and libpng has to. */

bool png_fast_decode(const uint8_t *data, size_t size, int64_t max_pixels, Image **image);

/* Two files with the same size in pixels: images[1] is images[0] if all pixels are equal, and the layouts. */
bool png_fast_decode_pair(const uint8_t *const data[2], const size_t sizes[2], int64_t max_pixels, Image *images[2]);

/* One file, or two with the same size in pixels, in memory for some rows. band: bytes of rows that are decompressed at
   once, at least one row. threads: with a second thread. */
enum { PNG_BAND = 1 << 17 };
bool png_fast_scan_rows(PngRows *const rows[], int files, size_t band, bool threads, const RowSink *sink);
bool png_fast_scan(const uint8_t *const data[], const size_t sizes[], int files, int64_t max_pixels, size_t band,
                   bool threads, const RowSink *sink);

/* Whether a file can be decoded. */
bool png_fast_check_rows(PngRows *rows);

/* Any file, by libpng; NULL with error set. What png_fast_decode() accepts, this accepts, with the same pixels;
   but for codes of deflate that are incomplete, which ISA-L reads and zlib refuses: the pixels have the right
   checksum. */
Image *png_libpng_decode(const uint8_t *data, size_t size, const char *path, int64_t max_pixels, Error *error);

/* Memory for libpng, and for zlib below it. They report a lack of memory as damage of the file, or only warn and skip a
   text; these functions, with a bool as their mem_ptr, set it. */

png_voidp png_memory_take(png_structp png, png_alloc_size_t size);
void png_memory_release(png_structp png, png_voidp block);

/* Bitmaps of glyphs that are not in the atlas, drawn from their outlines when text needs them. */

/* The size and place of a glyph at `pixels` per em; its offset is 0. */
FontGlyph glyph_metrics(const Typeface *face, const Glyph *glyph, int pixels);

/* Fills the glyph's bitmap in the levels of the atlas; false if out of memory. */
bool glyph_draw(const Typeface *face, const Glyph *glyph, int pixels, const FontGlyph *metrics, uint8_t *bitmap);

/* The GLSL of shaders/, embedded in the binary by tools/embed.cmake. */

extern const char shader_rect_vert[], shader_rect_frag[];
extern const char shader_shape_vert[], shader_shape_frag[];
extern const char shader_text_vert[], shader_text_frag[];
