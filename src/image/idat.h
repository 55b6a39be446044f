/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The compressed pixels of PNG files (the data of IDAT), made for frames of a sequence: flat colours, most rows like
   the one above, most rows like those of the frame before. Any picture comes out right; noise comes out larger
   than it went in. The bytes depend on the pixels alone. */
#pragma once
#include "image/image.h"

typedef struct Idat Idat;

/* For RGB pictures of 8 bits and this size. */
Idat *idat_create(int width, int height, Error *error);
void idat_destroy(Idat *idat);

/* Compresses an image without its alpha. `changed`, of one flag a row, tells where it may differ from the image before;
   NULL for everywhere. *data stays valid until the next call. After an error (memory) give NULL the next time. */
bool idat_encode(Idat *idat, const Image *image, const bool *changed, const uint8_t **data, size_t *size, Error *error);
