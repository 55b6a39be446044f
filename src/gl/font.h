/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line of text, UTF-8, at whole pixels. */
#pragma once
#include "gl/drawing.h"
#include "gl/font_atlas.h"

typedef enum FontFace { FONT_REGULAR, FONT_SEMIBOLD } FontFace;

/* A face at a size. Without glyphs (too small to read) all text has width 0 and adds nothing. */
typedef struct Font {
    const FontGlyph *glyphs;
    int pixels; /* an em */
} Font;

/* A space as wide as a figure: pads numbers. */
#define FIGURE_SPACE "\xE2\x80\x87"

/* The largest size not above `pixels`. */
Font font_pick(FontFace face, double pixels);

/* Width in pixels, rounded up. */
int font_width(const Font *font, const char *text);

/* Adds the text with its pen starting at x, and returns where the pen stands behind it. Characters that the
   font lacks, and bytes that are no UTF-8, show as '?'. */
int font_add(Drawing *drawing, const Font *font, const char *text, int x, int baseline, uint32_t color);

/* The same, cut short with an ellipsis to take at most max_width pixels. */
int font_add_fitting(Drawing *drawing, const Font *font, const char *text, int x, int baseline, int max_width,
                     uint32_t color);
