/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures in memory and as PNG (libpng). RGBA, 8 bits, top row first. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

typedef struct Image {
    int width, height;  /* pixels */
    uint8_t *pixels;    /* [height, width, 4] */
    uint16_t *pixels16; /* [height, width, 4] if read from a 16-bit PNG, otherwise NULL */
} Image;

/* All pixels are zero. NULL with error set if out of memory. */
Image *image_create(int width, int height, Error *error);
/* The same with pixels of any value, and room for further bytes behind them. */
Image *image_create_unset(int width, int height, size_t further, Error *error);
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

/* Copies the value of the first text with this key before the pixels. ERROR_INPUT if there is none, or if it needs
   more than `size` bytes. */
bool image_read_text(const char *path, const char *key, char *value, size_t size, Error *error);

/* The same for a file in memory; `value` is empty if the text is missing or cannot be read. False with error set only
   when memory is short. */
bool image_find_text(const uint8_t *data, size_t size, const char *key, char *value, size_t value_size, Error *error);

/* FNV-1a over width, height (4 bytes each) and the XXH3 of each row: equal for equal pictures, regardless of
   compression. */
uint64_t image_hash(const Image *image);

/* The same for a picture of a sequence: rows[height] holds the row hashes of the previous picture. `changed` flags
   the rows that differ; NULL: all. */
uint64_t image_hash_next(const Image *image, const bool *changed, uint64_t *rows);
