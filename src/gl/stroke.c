/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gl/stroke.h"

#include <math.h>

static const double HEAD = 4.2;      /* length of an arrow's head / thickness */
static const double MIN_HEAD = 3;    /* the same for short arrows */
static const double MIN_LENGTH = 2;  /* of an arrow / thickness */
static const double HALO = 1.0;      /* pixels on each side; at least a third of the thickness */
static const double NO_HALO = 1.0;   /* pixels; lines up to this thickness have no halo, which would be all to see */
static const double HALO_RISE = 2.5; /* of the halo, pixels per pixel of thickness from there */
static const double HEAD_SPACING = 0.85; /* between two heads / their length */
static const double HEAD_SINE = 0.5;     /* of half the angle between the head's sides, 30 degrees */
static const double HEAD_COSINE = 0.8660254037844386;
static const double TILE = 16;        /* pixels, side of a tile of a slanted line */
static const double MAX_TILED = 8000; /* pixels; longer shapes are reduced per tile, and their tiles would not
                                             match */
static const int MAX_DASHES = 10000;  /* of one segment; a line of 8,192 pixels has fewer */

/* The whole pixels that the line can touch between these columns (flat) or rows. */
static Rect tile_of(Point from, Point to, double thickness, bool flat, double first, double last) {
    double start = flat ? from.x : from.y, length = flat ? to.x - from.x : to.y - from.y;
    double a = fmin(fmax((first - start) / length, 0), 1), b = fmin(fmax((last - start) / length, 0), 1);
    double other = flat ? from.y : from.x, rise = flat ? to.y - from.y : to.x - from.x;
    double low = fmin(other + a * rise, other + b * rise), high = fmax(other + a * rise, other + b * rise);
    int before = (int)floor(low - 0.75 * thickness - 1), behind = (int)ceil(high + 0.75 * thickness + 1);
    return flat ? (Rect){(int)first, before, (int)last, behind} : (Rect){before, (int)first, behind, (int)last};
}

static Rect intersection(Rect a, const Rect *b) {
    return (Rect){a.left > b->left ? a.left : b->left, a.top > b->top ? a.top : b->top,
                  a.right < b->right ? a.right : b->right, a.bottom < b->bottom ? a.bottom : b->bottom};
}

/* A long slanted line touches few pixels of its bounding box, so it is drawn in disjoint tiles. */
static void add_in_tiles(Drawing *drawing, const Shape *line, Point from, Point to, double thickness,
                         const Rect *clip) {
    bool flat = fabs(to.x - from.x) > fabs(to.y - from.y);
    double low = flat ? fmin(from.x, to.x) : fmin(from.y, to.y), high = flat ? fmax(from.x, to.x) : fmax(from.y, to.y);
    double first = fmax(floor(low - thickness - 2), flat ? clip->left : clip->top);
    double last = fmin(ceil(high + thickness + 2), flat ? clip->right : clip->bottom);
    for (double at = first; at < last; at += TILE) {
        Rect part = intersection(tile_of(from, to, thickness, flat, at, fmin(at + TILE, last)), clip);
        if (part.left < part.right && part.top < part.bottom) drawing_add_shape(drawing, line, &part);
    }
}

void stroke_line(Drawing *drawing, Point from, Point to, double thickness, uint32_t color, const Rect *clip) {
    double dx = to.x - from.x, dy = to.y - from.y, length = sqrt(dx * dx + dy * dy);
    if (!isfinite(length)) return;
    Shape line = {.x = (from.x + to.x) / 2,
                  .y = (from.y + to.y) / 2,
                  .half_width = (length + thickness) / 2,
                  .half_height = thickness / 2,
                  .cosine = length > 0 ? dx / length : 1,
                  .sine = length > 0 ? -dy / length : 0,
                  .radius = thickness / 2,
                  .fill = color};
    if (fmin(fabs(dx), fabs(dy)) > TILE && length < MAX_TILED)
        add_in_tiles(drawing, &line, from, to, thickness, clip);
    else
        drawing_add_shape(drawing, &line, clip);
}

void stroke_dot(Drawing *drawing, Point center, double radius, uint32_t fill, uint32_t rim, const Rect *clip) {
    Shape dot = {.x = center.x,
                 .y = center.y,
                 .half_width = radius,
                 .half_height = radius,
                 .cosine = 1,
                 .radius = radius,
                 .outline = fmax(1, radius / 3),
                 .fill = fill,
                 .line = rim};
    drawing_add_shape(drawing, &dot, clip);
}

/* One side of the head at `tip`. (c, s) is the arrow's direction; `turn` is 1 or -1. */
static void draw_side(Drawing *drawing, Point tip, double c, double s, double turn, double size, double thickness,
                      uint32_t color, const Rect *clip) {
    double x = -c * HEAD_COSINE - turn * s * HEAD_SINE, y = -s * HEAD_COSINE + turn * c * HEAD_SINE;
    stroke_line(drawing, tip, (Point){tip.x + size * x, tip.y + size * y}, thickness, color, clip);
}

static void draw_arrow(Drawing *drawing, Point from, Point to, double head, bool truncated, double thickness,
                       uint32_t color, const Rect *clip) {
    double dx = to.x - from.x, dy = to.y - from.y, length = sqrt(dx * dx + dy * dy);
    double c = dx / length, s = dy / length;
    stroke_line(drawing, from, to, thickness, color, clip);
    for (int i = 0; i < (truncated ? 2 : 1); i++) {
        Point tip = {to.x - i * HEAD_SPACING * head * c, to.y - i * HEAD_SPACING * head * s};
        draw_side(drawing, tip, c, s, 1, head, thickness, color, clip);
        draw_side(drawing, tip, c, s, -1, head, thickness, color, clip);
    }
}

static double halo_width(double thickness) {
    return fmax(fmin(HALO, HALO_RISE * (thickness - NO_HALO)), thickness > 3 * HALO ? thickness / 3 : 0);
}

void stroke_arrow(Drawing *drawing, Point from, Point to, bool truncated, const ArrowStyle *style, const Rect *clip) {
    double dx = to.x - from.x, dy = to.y - from.y, length = sqrt(dx * dx + dy * dy), t = style->thickness;
    if (!(length >= MIN_LENGTH * t) || !isfinite(length)) return; /* nothing but head */
    double head = fmin(HEAD * t, fmax(MIN_HEAD * t, 0.6 * length));
    if (halo_width(t) > 0) draw_arrow(drawing, from, to, head, truncated, t + 2 * halo_width(t), style->halo, clip);
    draw_arrow(drawing, from, to, head, truncated, t, style->color, clip);
}

void stroke_dashed(Drawing *drawing, Point from, Point to, DashedLine *line, const Rect *clip) {
    const double t = line->thickness,
                 parts[] = {line->dash.on * t, line->dash.off * t, line->dash.on2 * t, line->dash.off2 * t};
    double dx = to.x - from.x, dy = to.y - from.y, length = sqrt(dx * dx + dy * dy), done = 0;
    double period = parts[0] + parts[1] + parts[2] + parts[3];
    if (!isfinite(length)) return;
    if (!(period > 0)) {
        stroke_line(drawing, from, to, t, line->color, clip);
        return;
    }
    for (int i = 0; i < MAX_DASHES && done < length; i++) {
        double at = fmod(line->travelled, period);
        int part = 0;
        while (part < 3 && at >= parts[part]) at -= parts[part++];
        double step = fmin(fmax(parts[part] - at, 0.01), length - done), end = done + step;
        if (part % 2 == 0)
            stroke_line(drawing, (Point){from.x + dx * done / length, from.y + dy * done / length},
                        (Point){from.x + dx * end / length, from.y + dy * end / length}, t, line->color, clip);
        done = end;
        line->travelled += step;
    }
}
