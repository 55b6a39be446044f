/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures in memory and as PNG (libpng). RGBA, 8 bits, top row first. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

typedef struct Image {
    int width, height; /* pixels */
    uint8_t *pixels;   /* [height, width, 4] */
    uint16_t *deep;    /* the same in 16 bits where it was read from a PNG of 16 bits, else NULL */
} Image;

/* Zeroed pixels. NULL with error set when memory is short. */
Image *image_create(int width, int height, Error *error);
void image_destroy(Image *image);

/* A tEXt/iTXt entry of a PNG. */
typedef struct ImageText {
    const char *key, *value;
} ImageText;

/* Writes an opaque 8-bit RGB PNG (alpha is dropped) that is in place only when whole. */
bool image_write_png(const Image *image, const char *path, const ImageText *texts, int count, Error *error);

enum { IMAGE_MAX_PIXELS = 100000000 };

/* Any still PNG that libpng can turn into RGBA, of at most IMAGE_MAX_PIXELS (checked before anything is inflated).
   Refuses damaged, truncated and animated files: ERROR_INPUT, naming the file. */
Image *image_read_png(const char *path, Error *error);

/* A whole file, as it lies on the disk. NULL with error set as image_decode_png() fails. */
uint8_t *image_load_png(const char *path, size_t *size, Error *error);

/* The same of a file in memory, with another limit; path is for messages. */
Image *image_decode_png(const uint8_t *data, size_t size, const char *path, int64_t max_pixels, Error *error);

/* The value of the first text with this key that stands before the pixels, into value. ERROR_INPUT where
   there is none, or it takes size bytes or more. */
bool image_read_text(const char *path, const char *key, char *value, size_t size, Error *error);

/* The same of a file in memory that may well have no such text: then, or where it cannot be read, value is empty. */
void image_find_text(const uint8_t *data, size_t size, const char *key, char *value, size_t value_size);

/* FNV-1a over width, height (4 bytes each) and the XXH3 of each row: equal for equal pictures, however the file was
   compressed. */
uint64_t image_hash(const Image *image);

/* The same for a picture of a sequence: rows[height] holds the hashes of the rows of the one before. `changed`, of one
   flag a row, tells which are others now; NULL for all. */
uint64_t image_hash_next(const Image *image, const bool *changed, uint64_t *rows);

/* Of two pictures of different size only same_size is filled. */
typedef struct ImageDifference {
    bool equal, same_size;
    int64_t pixels;               /* that differ */
    int64_t counted;              /* that are not masked */
    int largest;                  /* largest difference of a channel, 0..255; a part of one counts as one */
    int first_x, first_y;         /* first that differs, row by row; -1, -1 when equal */
    int left, top, right, bottom; /* what differs lies within; right and bottom are just outside */
} ImageDifference;
void image_compare(const Image *a, const Image *b, ImageDifference *difference);

/* The largest difference of a channel of one pixel, as above. The pictures have one size. */
int image_pixel_difference(const Image *a, const Image *b, size_t pixel);

/* masked[height, width], of a's size: where it is not 0, pixels do not count; NULL: all count. */
void image_compare_masked(const Image *a, const Image *b, const uint8_t *masked, ImageDifference *difference);
