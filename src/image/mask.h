/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pixels that a comparison ignores: rectangles and pictures. A picture masks where it is neither black nor
   transparent. */
#pragma once
#include "image/image.h"

enum { MASK_PARTS = 64 };

typedef struct MaskPart {
    int x, y, width, height; /* a rectangle, which may extend beyond the edges */
    Image *picture;          /* or NULL */
    const char *path;        /* of the picture; not owned */
} MaskPart;

typedef struct Mask {
    int count;
    MaskPart parts[MASK_PARTS];
} Mask;

/* ERROR_INPUT for more than MASK_PARTS parts or an unreadable picture. */
bool mask_add_rectangle(Mask *mask, int x, int y, int width, int height, Error *error);
bool mask_add_picture(Mask *mask, const char *path, Error *error);
void mask_free(Mask *mask);

/* The mask [height, width], 1 where masked; malloc'ed. ERROR_INPUT if a picture has another size; `path` names the
   frame in the message. */
uint8_t *mask_make(const Mask *mask, int width, int height, const char *path, Error *error);

/* Copies the masked pixels of `expected` to `actual`; masked NULL: none. Both pictures must have the same size. */
void image_copy_masked(const Image *expected, Image *actual, const uint8_t *masked);
