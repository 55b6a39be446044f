/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads common PNG files row by row, several times as fast as libpng: at most 8 bits per sample, not interlaced, nothing
   unusual. A function that returns false leaves the file to libpng, which decides whether it is damaged; so only what
   libpng would read, and as it would, may be accepted. */
#pragma once
#include "image/png_chunk.h"

#include <zlib.h>

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

/* The next row as it is stored, [1 + bytes], see image/png_filter.h; NULL: as false. */
const uint8_t *png_rows_next(PngRows *rows);

/* Whether the file ends with its last row, and the checksum of its rows is right. */
bool png_rows_end(PngRows *rows);

/* rgba[4 * width] for a row. False if a colour is not in the palette. */
bool png_expand(const PngLayout *layout, const uint8_t *row, uint8_t *rgba);

bool png_same_layout(const PngLayout *a, const PngLayout *b);
