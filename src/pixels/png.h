/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Images and PNG files: check, read, write. */
#pragma once
#include "base/base.h"

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Pictures in memory and as PNG. RGBA, 8 bits, top row first. */

typedef struct Image {
    int width, height;  /* pixels */
    uint8_t *pixels;    /* [height, width, 4] */
    uint16_t *pixels16; /* [height, width, 4] if read from a 16-bit PNG, otherwise NULL */
} Image;

/* All pixels are zero. NULL with error set if out of memory. */
Image *image_create(int width, int height, Error *error);
/* The same with pixels of any value. */
Image *image_create_unset(int width, int height, Error *error);
void image_destroy(Image *image);

/* Prepares memory of image_create_unset() of which all will be used; without this, it is only slower. */
void image_provide(Image *image);

/* A tEXt/iTXt entry of a PNG. */
typedef struct ImageText {
    const char *key, *value;
} ImageText;

/* Writes an opaque 8-bit RGB PNG (alpha is dropped). The file appears when complete. */
bool image_write_png(const Image *image, const char *path, const ImageText *texts, int count, Error *error);

enum { IMAGE_MAX_PIXELS = 100000000 };

/* Reads any still PNG of at most IMAGE_MAX_PIXELS, checked before decompression. ERROR_INPUT, naming the file, if it
   is damaged, truncated or animated. */
Image *image_read_png(const char *path, Error *error);

/* Reads a whole file without decoding it. NULL with error set, also if it does not begin as a PNG file. */
uint8_t *image_load_png(const char *path, size_t *size, Error *error);

/* Like image_read_png(), for a file in memory and with another limit; `path` is used in messages. */
Image *image_decode_png(const uint8_t *data, size_t size, const char *path, int64_t max_pixels, Error *error);

/* Two files. If all their pixels are equal, images[1] may be images[0]. image_destroy_pair() frees them, also after a
   failure. */
bool image_decode_png_pair(const uint8_t *const data[2], const size_t sizes[2], const char *const paths[2],
                           int64_t max_pixels, Image *images[2], Error *error);
void image_destroy_pair(Image *images[2]);

/* Takes the rows of one file or two, from the top. */
typedef struct RowSink {
    bool (*begin)(void *context, int width, int height);
    /* Room for row y of a side as RGBA, [4 * width]; NULL: out of memory. */
    uint8_t *(*place)(void *context, int side, int y);
    /* The rows in their places; a == b: they are equal, or there is one file. */
    void (*row)(void *context, int y, const uint8_t *a, const uint8_t *b);
    void *context;
    int around; /* of rows that are equal, at least those this near to one that differs; ROWS_ALL */
} RowSink;
enum { ROWS_ALL = INT_MAX };

/* A file to compare. A common one, of at most 8 bits per sample and not interlaced, is read in pieces, in little
   memory. */
typedef struct PngFile {
    const char *path;
    int64_t max_pixels;
    uint64_t hash; /* XXH3 of its bytes */
    uint8_t *data; /* [size] all of it; in pieces: with one empty chunk in place of its compressed pixels */
    size_t size;
    size_t bytes;         /* of the file, with its pixels */
    bool damaged;         /* as png_files_scan() has found */
    struct PngRows *rows; /* NULL: not in pieces */
} PngFile;

/* NULL with error set as image_load_png(). What is read in pieces is sound but for its compressed pixels, and has at
   most max_pixels. png_file_close() must follow. The path must last until then. */
bool png_file_open(PngFile *file, const char *path, int64_t max_pixels, Error *error);
void png_file_close(PngFile *file);

/* Reads the whole file. ERROR_INPUT if it has changed. */
bool png_file_load(PngFile *file, Error *error);

/* Whether image_decode_png() would read the file, in memory for some rows. At most once; then the file may be
   loaded. */
bool png_file_check(PngFile *file, Error *error);

/* Whether all bytes are equal. */
bool png_files_are_same(PngFile files[2]);

/* Reads two files in pieces row by row, once. False: a file is damaged or has changed, they are not read in pieces,
   have different sizes, or memory is short. Then some rows may have been given. threads: with a second thread. */
bool png_files_scan(PngFile files[2], bool threads, const RowSink *sink);

/* Copies the value of the first text with this key before the pixels of a file in memory. `value` is empty without such
   a text, if it cannot be read or needs more than `value_size` bytes. False with error set only when memory is
   short. */
bool image_find_text(const uint8_t *data, size_t size, const char *key, char *value, size_t value_size, Error *error);

/* FNV-1a over width, height (4 bytes each) and the XXH3 of each row: equal for equal pictures, regardless of
   compression. */
uint64_t image_hash(const Image *image);

/* The same for a picture of a sequence: rows[height] holds the row hashes of the previous picture. `changed` flags
   the rows that differ; NULL: all. */
uint64_t image_hash_next(const Image *image, const bool *changed, uint64_t *rows);

/* Encodes pictures of one size, one after another, to PNG files in memory: 8-bit RGB, alpha is dropped. */

typedef enum PngEffort {
    PNG_FAST, /* for frames: png_write.c */
    PNG_SMALL /* libpng, all filters, highest level: about 50 times slower */
} PngEffort;

typedef struct PngEncoder PngEncoder;

PngEncoder *png_encoder_create(int width, int height, PngEffort effort, Error *error);
void png_encoder_destroy(PngEncoder *encoder);

/* *data is the whole file, valid until the next call. `changed` flags the rows that may differ from the previous
   image; NULL: all, as for the first call and after an error. The bytes do not depend on `changed`. */
bool png_encode(PngEncoder *encoder, const Image *image, const bool *changed, const ImageText *texts, int count,
                const uint8_t **data, size_t *size, Error *error);

/* A place in double: metres, millimetres of a page or pixels of a picture, as its user states. */
typedef struct Point {
    double x, y;
} Point;

/* Checks that a file is a PNG picture without decompressing it, at the cost of a CRC over its bytes. For files that
   need no decoding, because they equal another file byte by byte: two truncated downloads are equal, too. */

/* The first bytes only. ERROR_INPUT if the file is empty, a Git LFS pointer or no PNG file. */
bool png_check_start(const uint8_t *data, size_t size, const char *path, Error *error);

/* The size that the header states; false if there is no valid header. Nothing else is checked. */
bool png_size(const uint8_t *data, size_t size, int *width, int *height);

/* ERROR_INPUT for more pixels than can be read. */
bool png_check_pixels(int width, int height, int64_t max_pixels, const char *path, Error *error);

/* The whole file: its chunks, their order and checksums, the header, and whether the compressed pixels can be complete:
   a valid zlib header, and at least the bytes that deflate needs for a picture of this size. ERROR_INPUT if
   image_decode_png() would refuse the file for one of these reasons, or as it is animated. What only decompression
   would find is left: damage that has correct checksums. */
bool png_check(const uint8_t *data, size_t size, const char *path, int *width, int *height, Error *error);

/* The chunks of a PNG file in memory, which may be damaged (PNG specification, section 5.3). */

enum { PNG_SIGNATURE = 8, PNG_CHUNK_FRAME = 12 }; /* bytes; of a chunk: length, type and checksum */

typedef struct PngChunk {
    const uint8_t *type; /* [4], followed by the data and the checksum */
    const uint8_t *data;
    size_t length;
} PngChunk;

static inline uint32_t png_number(const uint8_t bytes[4]) {
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* Reads the chunk at *at and moves *at behind it. False at the end of the file, and if the file ends within the
   chunk. */
static inline bool png_chunk_next(const uint8_t *file, size_t size, size_t *at, PngChunk *chunk) {
    if (*at > size || size - *at < PNG_CHUNK_FRAME) return false;
    *chunk = (PngChunk){file + *at + 4, file + *at + 8, png_number(file + *at)};
    if (chunk->length > size - *at - PNG_CHUNK_FRAME) return false;
    *at += chunk->length + PNG_CHUNK_FRAME;
    return true;
}

static inline bool png_chunk_is(const PngChunk *chunk, const char *type) { return memcmp(chunk->type, type, 4) == 0; }

/* Writes a PNG file of at most 256 colours in memory, row by row. It has a third of the bytes of RGB and takes a
   fraction of the time to compress. */

typedef struct Palette {
    int count;
    bool clear; /* colour 0 is transparent */
    uint8_t rgb[256][3];
} Palette;

typedef struct IndexedPng IndexedPng;

/* NULL with error set if out of memory. */
IndexedPng *indexed_png_create(int width, int height, const Palette *palette, Error *error);
void indexed_png_destroy(IndexedPng *png);

/* Room for a row, [width] indices of the palette; indexed_png_add() takes it as the next one. */
uint8_t *indexed_png_row(IndexedPng *png);
bool indexed_png_add(IndexedPng *png, Error *error);

/* The file, malloc'ed, once all rows are added. NULL with error set if out of memory. */
uint8_t *indexed_png_end(IndexedPng *png, size_t *size, Error *error);
