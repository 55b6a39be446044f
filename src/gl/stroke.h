/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines, dots and arrows, all made of the one shape that every machine draws alike. Pixels, y down. */
#pragma once
#include "common/point.h"
#include "gl/drawing.h"

/* A line with round ends. */
void stroke_line(Drawing *drawing, Point from, Point to, double thickness, uint32_t color, const Rect *clip);

/* A disc with a rim. */
void stroke_dot(Drawing *drawing, Point center, double radius, uint32_t fill, uint32_t rim, const Rect *clip);

typedef struct ArrowStyle {
    double thickness;
    uint32_t color, halo; /* the halo parts it from what lies below */
} ArrowStyle;

/* An open head at `to`, two where the arrow stands for a longer one. */
void stroke_arrow(Drawing *drawing, Point from, Point to, bool longer, const ArrowStyle *style, const Rect *clip);

/* Lengths of dash and gap in turns, as shares of the line's thickness; `on` = 0: solid. */
typedef struct Dash {
    double on, off, on2, off2;
} Dash;

/* A dashed line in pieces: `travelled` keeps the position in the dashes from one piece to the next and begins with 0. */
typedef struct DashedLine {
    double thickness, travelled;
    uint32_t color;
    Dash dash;
} DashedLine;
void stroke_dashed(Drawing *drawing, Point from, Point to, DashedLine *line, const Rect *clip);
