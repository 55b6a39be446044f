/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The glyphs of the most common characters as bitmaps, which tools/make_atlas.c embeds in the binary: the fonts of font/ in
   FONT_SIZES sizes. Others are drawn when they are needed (glyph_bitmap.h). */
#pragma once
#include <stdint.h>

enum { FONT_FACES = 2, FONT_SIZES = 24, FONT_GLYPHS = 106 };

typedef struct FontGlyph {
    unsigned code;       /* Unicode, ascending within a size */
    unsigned offset;     /* of the bitmap in font_bitmaps */
    short width, height; /* of the bitmap, pixels */
    short left, top;     /* of the bitmap, right of and above the pen */
    short advance;       /* of the pen, 1/64 pixel; equal for all digits */
} FontGlyph;

extern const int font_sizes[FONT_SIZES]; /* pixels per em, ascending */
extern const FontGlyph font_glyphs[FONT_FACES][FONT_SIZES][FONT_GLYPHS];
extern const uint8_t font_bitmaps[]; /* alpha, row by row */
extern const unsigned font_bitmaps_size;
