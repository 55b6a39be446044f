/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The content of a frame before OpenGL: rectangles, above them shapes, above these glyphs, each in the order they
   were added. The rectangles and the first `static_shapes` shapes form the static layer. Pixels, y down, (0, 0) is
   the picture's upper left corner; colours are 0xRRGGBB. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Whole pixels: left <= x < right, top <= y < bottom. */
typedef struct Rect {
    int left, top, right, bottom;
} Rect;

/* The input of shaders/rect.vert. */
typedef struct RectInstance {
    Rect rect;
    uint32_t color;
} RectInstance;

/* A rounded box. */
typedef struct Shape {
    double x, y; /* centre */
    double half_width, half_height;
    double cosine, sine;    /* of the angle, counter-clockwise on the screen */
    double radius, outline; /* corner radius; width of the outline, inside the box */
    double band;            /* thickness of the band along the local top; 0: none */
    bool hollow;            /* only the outline is drawn, in `line` */
    uint32_t fill, line, band_color;
} Shape;

enum { SHAPE_HOLLOW = 1 << 24 }; /* flag in the bits above the colour */

/* The input of shaders/shape.vert: lengths in 1/65536 pixel. */
typedef struct ShapeInstance {
    int32_t bounds[4];  /* the whole pixels to paint: left, top, right, bottom */
    int32_t axis[4];    /* direction of the local x axis; local position of the first pixel's centre */
    int32_t extents[4]; /* half width, half height, corner radius, outline */
    uint32_t paint[4];  /* fill or SHAPE_HOLLOW, line, band colour, band thickness */
} ShapeInstance;

/* The input of shaders/text.vert. */
typedef struct GlyphInstance {
    int32_t box[4];  /* left, top, width, height */
    uint32_t bitmap; /* index of the first texel in font_bitmaps, or after its end in the drawing's own bitmaps */
    uint32_t color;
} GlyphInstance;

/* Initialise with zeros. */
typedef struct Drawing {
    RectInstance *rects;
    ShapeInstance *shapes;
    GlyphInstance *glyphs;
    size_t rect_count, rect_capacity, shape_count, shape_capacity, glyph_count, glyph_capacity;
    uint8_t *bitmaps; /* of glyphs that font_bitmaps lacks, as there */
    size_t bitmap_size, bitmap_capacity;
    size_t static_shapes; /* the first shapes: like the rectangles, equal in almost every frame */
    bool failed;          /* out of memory: the drawing is incomplete */
} Drawing;

/* Removes all content, keeps the memory. */
void drawing_clear(Drawing *drawing);
void drawing_free(Drawing *drawing);

/* Adds the part of a shape inside `clip`. Ignores a shape that is outside or has NaN or infinite values. */
void drawing_add_shape(Drawing *drawing, const Shape *shape, const Rect *clip);

void drawing_add_rect(Drawing *drawing, Rect rect, uint32_t color);

void drawing_add_glyph(Drawing *drawing, const GlyphInstance *glyph);

/* Room for a bitmap of `size` bytes, zeros, with the index for its glyph; NULL if out of memory (`failed`). */
uint8_t *drawing_add_bitmap(Drawing *drawing, size_t size, uint32_t *bitmap);

/* Adds the shapes and glyphs of `from`, except its static shapes, clipped to the rows top <= y < bottom. */
void drawing_add_rows(Drawing *drawing, const Drawing *from, int top, int bottom);
