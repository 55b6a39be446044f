/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Decodes common PNG files (png_rows.h). False: nothing is decoded, and libpng has to. */
#pragma once
#include "image/image.h"

bool png_fast_decode(const uint8_t *data, size_t size, int64_t max_pixels, Image **image);

/* Two files with the same layout, row by row: images[1] is images[0] if all pixels are equal. */
bool png_fast_decode_pair(const uint8_t *const data[2], const size_t sizes[2], int64_t max_pixels, Image *images[2]);

/* Any file, by libpng; NULL with error set. What png_fast_decode() accepts, this accepts, with the same pixels. */
Image *png_libpng_decode(const uint8_t *data, size_t size, const char *path, int64_t max_pixels, Error *error);
