/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Encodes pictures of one size, one after another, to PNG files in memory: 8-bit RGB, alpha is dropped. */
#pragma once
#include "image/image.h"

typedef enum PngEffort {
    PNG_FAST, /* for frames; see idat.h */
    PNG_SMALL /* libpng, all filters, highest level: about 50 times slower */
} PngEffort;

typedef struct PngEncoder PngEncoder;

PngEncoder *png_encoder_create(int width, int height, PngEffort effort, Error *error);
void png_encoder_destroy(PngEncoder *encoder);

/* *data is the whole file, valid until the next call. `changed` flags the rows that may differ from the previous
   image; NULL: all, as for the first call and after an error. The bytes do not depend on `changed`. */
bool png_encode(PngEncoder *encoder, const Image *image, const bool *changed, const ImageText *texts, int count,
                const uint8_t **data, size_t *size, Error *error);
