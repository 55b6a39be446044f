/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line of UTF-8 text at whole pixels. */
#pragma once
#include "gl/drawing.h"
#include "gl/font_atlas.h"
#include "type/type.h"

typedef enum FontFace { FONT_REGULAR, FONT_SEMIBOLD } FontFace;

/* A face at a size. If it is too small to read, `glyphs` is NULL: all text has width 0 and adds nothing. */
typedef struct Font {
    const FontGlyph *glyphs;
    const Typeface *face; /* for the characters that these lack */
    int pixels;           /* per em */
} Font;

/* A space as wide as a digit, to pad numbers. */
#define FIGURE_SPACE "\xE2\x80\x87"

/* The largest size not above `pixels`. */
Font font_pick(FontFace face, double pixels);

/* In pixels, rounded up. */
int font_width(const Font *font, const char *text);

/* Adds text that starts at x and returns the x where it ends. Characters missing from the font and bytes that are
   not UTF-8 become '?'; type_check() refuses them before. */
int font_add(Drawing *drawing, const Font *font, const char *text, int x, int baseline, uint32_t color);

/* The same, shortened with an ellipsis to at most max_width pixels. */
int font_add_fitting(Drawing *drawing, const Font *font, const char *text, int x, int baseline, int max_width,
                     uint32_t color);
