/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures of at most 256 colours, as PNG files: a third of the bytes of RGB, compressed in a fraction of the time. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

typedef struct IndexedImage {
    int width, height;
    uint8_t *rows; /* [height, 1 + width]: 0, PNG's mark of an unfiltered row, then indices of colours */
    int colors;
    uint8_t palette[256][3];
} IndexedImage;

/* All pixels have colour 0, and there are no colours yet. NULL with error set if out of memory. */
IndexedImage *indexed_image_create(int width, int height, Error *error);
void indexed_image_destroy(IndexedImage *image);

/* The pixels of a row. */
uint8_t *indexed_image_row(const IndexedImage *image, int y);

/* A PNG file in memory, malloc'ed. NULL with error set if out of memory. */
uint8_t *indexed_image_encode(const IndexedImage *image, size_t *size, Error *error);
