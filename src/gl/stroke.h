/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines, dots and arrows, all made of drawing.h's shape, which is pixel-exact on every machine. Pixels, y down. */
#pragma once
#include "common/point.h"
#include "gl/drawing.h"

/* A line with round caps. */
void stroke_line(Drawing *drawing, Point from, Point to, double thickness, uint32_t color, const Rect *clip);

/* A disc with a rim. */
void stroke_dot(Drawing *drawing, Point center, double radius, uint32_t fill, uint32_t rim, const Rect *clip);

typedef struct ArrowStyle {
    double thickness;
    uint32_t color, halo; /* the halo separates it from what is below */
} ArrowStyle;

/* An open head at `to`; two heads if the arrow is drawn shorter than its value (`truncated`). */
void stroke_arrow(Drawing *drawing, Point from, Point to, bool truncated, const ArrowStyle *style, const Rect *clip);

/* Alternating lengths of dashes and gaps, in units of the line's thickness; `on` = 0: solid. */
typedef struct Dash {
    double on, off, on2, off2;
} Dash;

/* Carries the dash phase from one segment of a polyline to the next; start with travelled = 0. */
typedef struct DashedLine {
    double thickness, travelled;
    uint32_t color;
    Dash dash;
} DashedLine;
void stroke_dashed(Drawing *drawing, Point from, Point to, DashedLine *line, const Rect *clip);
