/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checks that a file is a PNG picture without decompressing it, at the cost of a CRC over its bytes. For files that need
   no decoding, because they equal another file byte by byte: two truncated downloads are equal, too. */
#pragma once
#include "common/error.h"

#include <stddef.h>
#include <stdint.h>

/* The first bytes only. ERROR_INPUT if the file is empty, a Git LFS pointer or no PNG file. */
bool png_check_start(const uint8_t *data, size_t size, const char *path, Error *error);

/* The size that the header states; false if there is no valid header. Nothing else is checked. */
bool png_size(const uint8_t *data, size_t size, int *width, int *height);

/* ERROR_INPUT for more pixels than can be read. */
bool png_check_pixels(int width, int height, int64_t max_pixels, const char *path, Error *error);

/* The whole file: its chunks, their order and checksums, the header, and whether the compressed pixels can be complete: a
   valid zlib header, and at least the bytes that deflate needs for a picture of this size. ERROR_INPUT if
   image_decode_png() would refuse the file for one of these reasons, or as it is animated. What only decompression would
   find is left: damage that has correct checksums. */
bool png_check(const uint8_t *data, size_t size, const char *path, int *width, int *height, Error *error);
