/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compressed pixels of PNG files (IDAT), optimised for frames of a sequence: flat colours, most rows equal to the
   row above and to that of the previous frame. Correct for every picture, but noise grows. The bytes depend only on
   the pixels. */
#pragma once
#include "image/image.h"

typedef struct Idat Idat;

/* For 8-bit RGB pictures of this size. */
Idat *idat_create(int width, int height, Error *error);
void idat_destroy(Idat *idat);

/* Compresses an image without its alpha. `changed` flags the rows that may differ from the previous image; NULL:
   all. *data is valid until the next call. After an error (out of memory), pass NULL in the next call. */
bool idat_encode(Idat *idat, const Image *image, const bool *changed, const uint8_t **data, size_t *size, Error *error);
