/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The glyphs that tools/make_atlas.c puts into the binary: the fonts of font/ at FONT_SIZES heights. */
#pragma once
#include <stdint.h>

enum { FONT_FACES = 2, FONT_SIZES = 24, FONT_GLYPHS = 106 };

typedef struct FontGlyph {
    unsigned code;       /* Unicode; rising within a size */
    unsigned offset;     /* of its bitmap in font_bitmaps */
    short width, height; /* of the bitmap, pixels */
    short left, top;     /* of the bitmap from the pen: to the right, up */
    short advance;       /* of the pen, 1/64 pixel; the same for all figures */
} FontGlyph;

extern const int font_sizes[FONT_SIZES]; /* pixels an em, rising */
extern const FontGlyph font_glyphs[FONT_FACES][FONT_SIZES][FONT_GLYPHS];
extern const uint8_t font_bitmaps[]; /* alpha, row by row */
extern const unsigned font_bitmaps_size;
