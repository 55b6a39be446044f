/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pixels that a comparison ignores: rectangles, pictures and colours.

     Mask mask = {0};
     mask_add_rectangle(&mask, 0, 0, 320, 20, error);
     mask_draw(&mask, expected, path, masked, error);
     mask_free(&mask); */
#pragma once
#include "base/base.h"
#include "pixels/png.h"

#include <stdint.h>

enum { MASK_PARTS = 64 };

typedef enum MaskKind { MASK_RECTANGLE, MASK_PICTURE, MASK_COLOR } MaskKind;

typedef struct MaskPart {
    MaskKind kind;
    int x, y, width, height;     /* of a rectangle, which may extend beyond the edges; at most 1,000,000 */
    struct MaskPicture *picture; /* masks where it is neither black nor transparent */
    uint8_t color[3];            /* masks opaque pixels that have this colour in the expected picture */
} MaskPart;

typedef struct Mask {
    int count;
    MaskPart parts[MASK_PARTS];
} Mask;

/* ERROR_INPUT for more than MASK_PARTS parts or an unreadable picture; its pixels are decompressed when it is drawn. */
bool mask_add_rectangle(Mask *mask, int x, int y, int width, int height, Error *error);
bool mask_add_picture(Mask *mask, const char *path, Error *error);
bool mask_add_color(Mask *mask, const uint8_t color[3], Error *error);
void mask_free(Mask *mask);

/* Sets the masked bytes to IGNORED_MASK. ERROR_INPUT if a picture has another size than the expected picture, or pixels
   that are damaged; `path` names the expected picture in the message. Threads may share a mask. */
bool mask_draw(const Mask *mask, const Image *expected, const char *path, uint8_t *masked, Error *error);

/* How many pixels of a picture of this size the mask hides at most, or all if it may not fit to it. An upper bound that
   costs no pass over pixels. */
double mask_most_hidden(const Mask *mask, int width, int height);
