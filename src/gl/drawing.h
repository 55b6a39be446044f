/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a frame consists of, before OpenGL sees it: rectangles, above them shapes, above these glyphs, each in
   the order they were added. The rectangles and the first shapes are those that keep still. Pixels, y down, (0, 0) the
   upper left corner of the picture; colours 0xRRGGBB. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Whole pixels: left <= x < right, top <= y < bottom. */
typedef struct Rect {
    int left, top, right, bottom;
} Rect;

/* As shaders/rect.vert wants it. */
typedef struct RectInstance {
    Rect rect;
    uint32_t color;
} RectInstance;

/* A rounded box. */
typedef struct Shape {
    double x, y; /* centre */
    double half_width, half_height;
    double cosine, sine;    /* of its angle, counter-clockwise as seen */
    double radius, outline; /* of the corners; width of the outline, inside the box */
    double band;            /* thickness of the band along the local top; 0: none */
    bool hollow;            /* the outline alone, in `line`: what lies below shows inside it */
    uint32_t fill, line, band_color;
} Shape;

enum { SHAPE_HOLLOW = 1 << 24 }; /* beside the colour */

/* As shaders/shape.vert wants it: lengths in 1/65536 pixel. */
typedef struct ShapeInstance {
    int32_t bounds[4]; /* the whole pixels to paint: left, top, right, bottom */
    int32_t axis[4];   /* direction of the local x axis, local position of the first pixel's centre */
    int32_t form[4];   /* half width, half height, corner radius, outline */
    uint32_t paint[4]; /* fill (SHAPE_HOLLOW: none), line, colour and thickness of the band */
} ShapeInstance;

/* As shaders/text.vert wants it. */
typedef struct GlyphInstance {
    int32_t box[4];  /* left, top, width, height */
    uint32_t bitmap; /* index of its first texel in font_bitmaps */
    uint32_t color;
} GlyphInstance;

/* Zero it to begin with. */
typedef struct Drawing {
    RectInstance *rects;
    ShapeInstance *shapes;
    GlyphInstance *glyphs;
    size_t rect_count, rect_capacity, shape_count, shape_capacity, glyph_count, glyph_capacity;
    size_t still_shapes; /* the first of the shapes: like the rectangles, the same in almost every frame */
    bool failed;         /* memory was short: something is missing */
} Drawing;

/* Removes everything, keeps the memory. */
void drawing_clear(Drawing *drawing);
void drawing_free(Drawing *drawing);

/* Adds the part of a shape inside `clip`. What cannot be seen there, or has no finite place, adds nothing. */
void drawing_add_shape(Drawing *drawing, const Shape *shape, const Rect *clip);

void drawing_add_rect(Drawing *drawing, Rect rect, uint32_t color);

void drawing_add_glyph(Drawing *drawing, const GlyphInstance *glyph);

/* Adds to a drawing what another shows, but for what keeps still, in the rows top <= y < bottom. */
void drawing_add_rows(Drawing *drawing, const Drawing *from, int top, int bottom);
