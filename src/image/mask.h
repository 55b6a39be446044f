/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pixels that a comparison leaves out: rectangles, and pictures. A picture masks where it is neither black nor
   transparent. */
#pragma once
#include "image/image.h"

enum { MASK_PARTS = 64 };

typedef struct MaskPart {
    int x, y, width, height; /* of a rectangle, which may reach over the edges */
    Image *picture;          /* or NULL */
    const char *path;        /* of the picture; not owned */
} MaskPart;

typedef struct Mask {
    int count;
    MaskPart parts[MASK_PARTS];
} Mask;

/* ERROR_INPUT for more than MASK_PARTS parts, and for a picture that cannot be read. */
bool mask_add_rectangle(Mask *mask, int x, int y, int width, int height, Error *error);
bool mask_add_picture(Mask *mask, const char *path, Error *error);
void mask_free(Mask *mask);

/* [height, width], 1 where masked: malloc'ed. ERROR_INPUT where a picture has another size; path, of the frame, is for
   that message. */
uint8_t *mask_make(const Mask *mask, int width, int height, const char *path, Error *error);

/* Makes the masked pixels of actual look as expected; masked NULL: none. Pictures of one size. */
void image_cover(const Image *expected, Image *actual, const uint8_t *masked);
