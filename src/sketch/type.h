/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The words of a sketch: outlines and widths of Inter, made by tools/make_outlines.c. In the font's units, y up. */
#pragma once

typedef enum OutlineKind { OUTLINE_MOVE, OUTLINE_LINE, OUTLINE_CURVE } OutlineKind;

/* A curve (Bezier's, cubic) is three steps: two control points and its end. */
typedef struct OutlineStep {
    short kind, x, y;
} OutlineStep;

typedef struct Glyph {
    unsigned code, index;      /* Unicode, rising; number in the font file */
    int advance, first, steps; /* of the pen; its part of type_steps */
} Glyph;

extern const int type_units, type_glyph_count; /* units an em */
extern const Glyph type_glyphs[];
extern const OutlineStep type_steps[];

/* The glyph of the next character of UTF-8, and *text moved behind it; '?' where the font lacks it. */
const Glyph *type_next(const char **text);

/* In the font's units. */
int type_advance(const char *text);

/* mm at a size in points. */
double type_width(const char *text, double points);

#define MM_PER_POINT (25.4 / 72)

/* The middle of capitals and figures above the baseline, of an em. */
#define TYPE_MIDDLE 0.3635
