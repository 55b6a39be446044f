/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Converts shapes to the integers of the shader. Everything that could be rounded in more than one way is rounded
   here, in double, to a grid far coarser than double's own error. */
#include "base/base.h"
#include "base/numbers.h"
#include "pixels/gl.h"
#include "pixels/png.h"
#include "pixels/strokes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double FIXED = 65536.0;        /* shader units per pixel */
static const double SNAP = 256.0;           /* positions and sizes are multiples of 1/256 pixel */
static const double MAX_HALF_SIZE = 8192.0; /* pixels; larger boxes are reduced, or the shader's integers overflow */

void drawing_clear(Drawing *drawing) {
    drawing->rect_count = drawing->shape_count = drawing->glyph_count = drawing->static_shapes = 0;
    drawing->bitmap_size = 0;
    drawing->failed = false;
}

void drawing_free(Drawing *drawing) {
    free(drawing->rects);
    free(drawing->shapes);
    free(drawing->glyphs);
    free(drawing->bitmaps);
    *drawing = (Drawing){0};
}

static double snap(double pixels) { return rint(pixels * SNAP) / SNAP; }
static int32_t fixed(double pixels) { return (int32_t)rint(pixels * FIXED); }

/* Clamps the interval [-*half, *half] to MAX_HALF_SIZE / 2 beyond [low, high]. Returns its new centre. */
static double clamp_interval(double low, double high, double *half) {
    double first = fmax(-*half, low - MAX_HALF_SIZE / 2), last = fmin(*half, high + MAX_HALF_SIZE / 2);
    *half = (last - first) / 2;
    return (first + last) / 2;
}

/* Removes what is far outside the clip from a very large box, and its band with it. */
static void limit_size(Shape *shape, const Rect *clip) {
    if (shape->half_width <= MAX_HALF_SIZE && shape->half_height <= MAX_HALF_SIZE) return;
    double c = shape->cosine, s = shape->sine;
    double x = (clip->left + clip->right) / 2.0, y = (clip->top + clip->bottom) / 2.0;
    double w = (clip->right - clip->left) / 2.0, h = (clip->bottom - clip->top) / 2.0;
    double local_x = (x - shape->x) * c - (y - shape->y) * s;
    double local_y = -(x - shape->x) * s - (y - shape->y) * c;
    double reach_x = fabs(c) * w + fabs(s) * h, reach_y = fabs(s) * w + fabs(c) * h;
    double center_x = clamp_interval(local_x - reach_x, local_x + reach_x, &shape->half_width);
    double center_y = clamp_interval(local_y - reach_y, local_y + reach_y, &shape->half_height);
    shape->x += center_x * c - center_y * s;
    shape->y -= center_x * s + center_y * c;
    shape->band = 0;
}

static bool is_drawable(const Shape *shape) {
    return fabs(shape->x) < MAX_COORDINATE && fabs(shape->y) < MAX_COORDINATE && shape->half_width > 0 &&
           shape->half_height > 0 && shape->half_width < MAX_COORDINATE && shape->half_height < MAX_COORDINATE &&
           isfinite(shape->cosine) && isfinite(shape->sine);
}

/* Room for `wanted` items. */
static bool reserve(Drawing *drawing, void **items, size_t *capacity, size_t wanted, size_t size) {
    const bool done = array_reserve(items, capacity, wanted, size);
    drawing->failed = drawing->failed || !done;
    return done;
}

static ShapeInstance *next_shape(Drawing *drawing) {
    const size_t wanted = drawing->shape_count + 1;
    return reserve(drawing, (void **)&drawing->shapes, &drawing->shape_capacity, wanted, sizeof *drawing->shapes)
               ? &drawing->shapes[drawing->shape_count]
               : NULL;
}

void drawing_add_shape(Drawing *drawing, const Shape *original, const Rect *clip) {
    if (!is_drawable(original)) return; /* keeps NaN away from limit_size() */
    Shape shape = *original;
    limit_size(&shape, clip);
    if (!is_drawable(&shape)) return;
    shape.x = snap(shape.x), shape.y = snap(shape.y);
    shape.half_width = snap(shape.half_width), shape.half_height = snap(shape.half_height);

    /* The whole pixels inside `clip` that the snapped shape can touch. */
    const double reach_x = fabs(shape.cosine) * shape.half_width + fabs(shape.sine) * shape.half_height + 1;
    const double reach_y = fabs(shape.sine) * shape.half_width + fabs(shape.cosine) * shape.half_height + 1;
    const int32_t left = (int32_t)fmax(floor(shape.x - reach_x), clip->left),
                  top = (int32_t)fmax(floor(shape.y - reach_y), clip->top),
                  right = (int32_t)fmin(ceil(shape.x + reach_x), clip->right),
                  bottom = (int32_t)fmin(ceil(shape.y + reach_y), clip->bottom);
    ShapeInstance *instance = left < right && top < bottom ? next_shape(drawing) : NULL;
    if (instance == NULL) return;

    /* The local axes are (c, -s) and (-s, -c), y pointing down. They are rounded first, so that the position below
       agrees with the shader's steps of one pixel. A hollow shape has one colour throughout, or its inner edge would
       blend with another colour. */
    const int32_t c = fixed(shape.cosine), s = fixed(-shape.sine);
    const double x = left + 0.5 - shape.x, y = top + 0.5 - shape.y;
    const bool hollow = shape.hollow;
    *instance = (ShapeInstance){.bounds = {left, top, right, bottom},
                                .axis = {c, s, (int32_t)rint(c * x + s * y), (int32_t)rint(s * x - c * y)},
                                .extents = {fixed(shape.half_width), fixed(shape.half_height),
                                            fixed(fmin(shape.radius, fmin(shape.half_width, shape.half_height))),
                                            fixed(fmin(shape.outline, MAX_HALF_SIZE))},
                                .paint = {hollow ? shape.line | SHAPE_HOLLOW : shape.fill,
                                          hollow || shape.outline > 0 ? shape.line : shape.fill,
                                          hollow           ? shape.line
                                          : shape.band > 0 ? shape.band_color
                                                           : shape.fill,
                                          (uint32_t)fixed(shape.band)}};
    drawing->shape_count++;
}

void drawing_add_rect(Drawing *drawing, Rect rect, uint32_t color) {
    const size_t i = drawing->rect_count;
    if (reserve(drawing, (void **)&drawing->rects, &drawing->rect_capacity, i + 1, sizeof *drawing->rects))
        drawing->rects[drawing->rect_count++] = (RectInstance){rect, color};
}

void drawing_add_glyph(Drawing *drawing, const GlyphInstance *glyph) {
    const size_t i = drawing->glyph_count;
    if (reserve(drawing, (void **)&drawing->glyphs, &drawing->glyph_capacity, i + 1, sizeof *glyph))
        drawing->glyphs[drawing->glyph_count++] = *glyph;
}

uint8_t *drawing_add_bitmap(Drawing *drawing, size_t size, uint32_t *bitmap) {
    const size_t start = drawing->bitmap_size, wanted = start + size;
    if (!reserve(drawing, (void **)&drawing->bitmaps, &drawing->bitmap_capacity, wanted, 1)) return NULL;
    drawing->bitmap_size = wanted;
    *bitmap = (uint32_t)(font_bitmaps_size + start);
    return memset(drawing->bitmaps + start, 0, size);
}

void drawing_add_part(Drawing *drawing, const Drawing *from, const Rect *part) {
    for (size_t i = from->static_shapes; i < from->shape_count; i++) {
        const ShapeInstance *whole = &from->shapes[i];
        const int32_t *bounds = whole->bounds, left = int_max(bounds[0], part->left),
                      top = int_max(bounds[1], part->top), right = int_min(bounds[2], part->right),
                      bottom = int_min(bounds[3], part->bottom);
        ShapeInstance *shape = left < right && top < bottom ? next_shape(drawing) : NULL;
        if (shape == NULL) continue;
        /* Its local position moves by whole steps of the shader. */
        const int64_t x = left - bounds[0], y = top - bounds[1], c = whole->axis[0], s = whole->axis[1];
        *shape = *whole;
        memcpy(shape->bounds, (int32_t[]){left, top, right, bottom}, sizeof shape->bounds);
        shape->axis[2] = (int32_t)(shape->axis[2] + x * c + y * s);
        shape->axis[3] = (int32_t)(shape->axis[3] + x * s - y * c);
        drawing->shape_count++;
    }
    for (size_t i = 0; i < from->glyph_count; i++) {
        const GlyphInstance *whole = &from->glyphs[i];
        const int32_t *box = whole->box, left = int_max(box[0], part->left), top = int_max(box[1], part->top),
                      right = int_min(box[0] + box[2], part->right), bottom = int_min(box[1] + box[3], part->bottom);
        if (left >= right || top >= bottom) continue;
        const uint32_t skipped = (uint32_t)(top - box[1]) * whole->stride + (uint32_t)(left - box[0]);
        drawing_add_glyph(drawing, &(GlyphInstance){{left, top, right - left, bottom - top},
                                                    whole->bitmap + skipped,
                                                    whole->stride,
                                                    whole->color});
    }
}

static const double TILE = 16;        /* pixels, side of a tile of a slanted line */
static const double MAX_TILED = 8000; /* pixels; longer shapes are reduced per tile, and their tiles would not
                                             match */
static const int MAX_DASHES = 10000;  /* of one segment; a line of 8,192 pixels has fewer */

/* A long slanted line touches few pixels of its bounding box, so it is drawn in disjoint tiles: the whole pixels that
   it can touch between some columns (flat) or rows. */
static void add_in_tiles(Drawing *drawing, const Shape *line, Point from, Point to, double thickness,
                         const Rect *clip) {
    const bool flat = fabs(to.x - from.x) > fabs(to.y - from.y);
    const double start = flat ? from.x : from.y, length = flat ? to.x - from.x : to.y - from.y;
    const double other = flat ? from.y : from.x, rise = flat ? to.y - from.y : to.x - from.x;
    const double low = fmin(start, flat ? to.x : to.y), high = fmax(start, flat ? to.x : to.y);
    const double first = fmax(floor(low - thickness - 2), flat ? clip->left : clip->top);
    const double last = fmin(ceil(high + thickness + 2), flat ? clip->right : clip->bottom);
    for (double at = first; at < last; at += TILE) {
        const double end = fmin(at + TILE, last);
        const double a = fmin(fmax((at - start) / length, 0), 1), b = fmin(fmax((end - start) / length, 0), 1);
        const double least = fmin(other + a * rise, other + b * rise), most = fmax(other + a * rise, other + b * rise);
        const int before = (int)floor(least - 0.75 * thickness - 1), behind = (int)ceil(most + 0.75 * thickness + 1);
        Rect part = flat ? (Rect){(int)at, before, (int)end, behind} : (Rect){before, (int)at, behind, (int)end};
        part = (Rect){int_max(part.left, clip->left), int_max(part.top, clip->top), int_min(part.right, clip->right),
                      int_min(part.bottom, clip->bottom)};
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

static void draw_arrow(Drawing *drawing, Point from, Point to, double head, bool truncated, double thickness,
                       uint32_t color, const Rect *clip) {
    double dx = to.x - from.x, dy = to.y - from.y, length = sqrt(dx * dx + dy * dy);
    double c = dx / length, s = dy / length;
    stroke_line(drawing, from, to, thickness, color, clip);
    for (int i = 0; i < (truncated ? 2 : 1); i++) {
        Point tip = {to.x - i * HEAD_SPACING * head * c, to.y - i * HEAD_SPACING * head * s};
        for (int turn = 1; turn >= -1; turn -= 2) { /* the sides of the head */
            const double x = -c * HEAD_COSINE - turn * s * HEAD_SINE, y = -s * HEAD_COSINE + turn * c * HEAD_SINE;
            stroke_line(drawing, tip, (Point){tip.x + head * x, tip.y + head * y}, thickness, color, clip);
        }
    }
}

void stroke_arrow(Drawing *drawing, Point from, Point to, bool truncated, const ArrowStyle *style, const Rect *clip) {
    double dx = to.x - from.x, dy = to.y - from.y, length = sqrt(dx * dx + dy * dy), t = style->thickness;
    if (!(length >= MIN_LENGTH * t) || !isfinite(length)) return; /* nothing but head */
    double head = fmin(HEAD * t, fmax(MIN_HEAD * t, HEAD_SHARE * length));
    const double halo = fmax(fmin(HALO, HALO_RISE * (t - NO_HALO)), t > 3 * HALO ? t / 3 : 0);
    if (halo > 0) draw_arrow(drawing, from, to, head, truncated, t + 2 * halo, style->halo, clip);
    draw_arrow(drawing, from, to, head, truncated, t, style->color, clip);
}

double dash_left(const double parts[4], double travelled, bool *on) {
    double at = fmod(travelled, parts[0] + parts[1] + parts[2] + parts[3]);
    int part = 0;
    while (part < 3 && at >= parts[part]) at -= parts[part++];
    *on = part % 2 == 0;
    return fmax(parts[part] - at, 0.01);
}

void stroke_dashed(Drawing *drawing, Point from, Point to, DashedLine *line, const Rect *clip) {
    const double t = line->thickness,
                 parts[] = {line->dash.on * t, line->dash.off * t, line->dash.on2 * t, line->dash.off2 * t};
    double dx = to.x - from.x, dy = to.y - from.y, length = sqrt(dx * dx + dy * dy), done = 0;
    if (!isfinite(length)) return;
    if (!(parts[0] + parts[1] + parts[2] + parts[3] > 0)) {
        stroke_line(drawing, from, to, t, line->color, clip);
        return;
    }
    for (int i = 0; i < MAX_DASHES && done < length; i++) {
        bool on;
        double step = fmin(dash_left(parts, line->travelled, &on), length - done), end = done + step;
        if (on)
            stroke_line(drawing, (Point){from.x + dx * done / length, from.y + dy * done / length},
                        (Point){from.x + dx * end / length, from.y + dy * end / length}, t, line->color, clip);
        done = end;
        line->travelled += step;
    }
}
