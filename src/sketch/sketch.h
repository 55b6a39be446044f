/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Drawings made of boxes, lines, arrows and words, for a page: kept as a list, then written as PNG, SVG or PDF
   (sketch_files.h). All lengths on the page in mm, from its lower left corner; what comes later lies above what came
   before, pictures below all and arrows and words above all. */
#pragma once
#include "collision/manifold.h"
#include "common/error.h"
#include "common/point.h"
#include "image/image.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* 0xRRGGBB, as in picture/style.h. Boxes are blue and the network is orange in the renderer's pictures, too; ACCENT is
   what the eye is to find: black in a grey print and beside Okabe and Ito's colours. */
#define BOX_COLOUR 0x0072B2u
#define BOX_INK 0x00395Cu
#define NETWORK_COLOUR 0xE69F00u
#define NETWORK_INK 0x7A4F00u
#define ACCENT 0x000000u
#define NO_COLOUR UINT32_MAX

#define LINE_UNIT 0.17 /* mm */

/* How a shape is drawn. */
typedef struct Pen {
    uint32_t fill; /* NO_COLOUR: not filled */
    double opacity;
    uint32_t line;      /* NO_COLOUR: no line */
    double width;       /* of the line, LINE_UNIT */
    const char *dashes; /* "(6,5)": dash and gap, twice at most, in LINE_UNIT; NULL: solid. Outlives the sketch */
} Pen;

static inline Pen pen_line(uint32_t line, double width, const char *dashes) {
    return (Pen){NO_COLOUR, 1, line, width, dashes};
}

static inline Pen pen_fill(uint32_t fill, double opacity, uint32_t line) {
    return (Pen){fill, opacity, line, 1.2, NULL};
}

/* A window of the page onto the world: metre (center) lies in its middle. */
typedef struct View {
    Point low, high; /* corners of the window, mm */
    Point center;    /* m */
    double scale;    /* mm a metre */
} View;

Point view_place(const View *view, Vec2 position);

enum { SKETCH_TEXT_SIZE = 200 };

typedef enum TextAlign { TEXT_LEFT, TEXT_CENTER, TEXT_RIGHT } TextAlign;

typedef struct TextStyle {
    double points; /* of type */
    TextAlign align;
    uint32_t colour;
    double degrees; /* turned counter-clockwise */
    bool halo;      /* with a white edge, to be read over a picture */
} TextStyle;

/* In the order in which they lie above each other. */
typedef enum SketchLayer { LAYER_PICTURES, LAYER_SHAPES, LAYER_ARROWS, LAYER_WORDS, SKETCH_LAYERS } SketchLayer;

typedef enum SketchMarkKind { MARK_IMAGE, MARK_PATH, MARK_TEXT } SketchMarkKind;

/* One thing on the page. */
typedef struct SketchMark {
    SketchLayer layer;
    SketchMarkKind kind;
    Point at;     /* lower left corner of an image; of words */
    double width; /* mm, of an image */
    Image *image;
    Pen pen;
    bool closed;
    size_t first, count; /* of a path: its part of the sketch's points */
    TextStyle style;
    size_t text; /* where it begins in the sketch's texts */
} SketchMark;

typedef struct Sketch {
    double width, height; /* mm */
    SketchMark *marks;
    Point *points;
    char *texts;
    size_t mark_count, mark_capacity, point_count, point_capacity, text_size, text_capacity;
    bool failed; /* memory was short: something is missing */
} Sketch;

/* A sketch begun is to be freed. */
void sketch_begin(Sketch *sketch, double width, double height);
void sketch_free(Sketch *sketch);

/* A picture with its lower left corner at `low`, `width` mm wide; its alpha counts. It is copied. */
void sketch_image(Sketch *sketch, const Image *image, Point low, double width);

/* A line through points, or the closed shape that they bound. */
void sketch_path(Sketch *sketch, const Point *points, int count, const Pen *pen);
void sketch_shape(Sketch *sketch, const Point *points, int count, const Pen *pen);
void sketch_line(Sketch *sketch, Point from, Point to, const Pen *pen);
void sketch_rectangle(Sketch *sketch, Point low, Point high, const Pen *pen);
void sketch_dot(Sketch *sketch, Point at, double radius, const Pen *pen);

/* A line with a head at its end, or at both. */
typedef enum ArrowHeads { HEAD_AT_END, HEADS_AT_BOTH } ArrowHeads;
void sketch_arrow(Sketch *sketch, Point from, Point to, ArrowHeads heads, uint32_t colour, double width);

/* A shape of the world, cut off at the window's edge. */
void sketch_box(Sketch *sketch, const View *view, const Box *box, const Pen *pen);

/* A line of words, cut to SKETCH_TEXT_SIZE - 1 bytes, its middle at the height of `at`. */
void sketch_text(Sketch *sketch, Point at, const TextStyle *style, const char *format, ...) PRINTF_LIKE(4, 5);

/* A number with so many decimals, for a text: with a minus as wide as a plus, and none before 0. */
typedef struct ShownDecimals {
    char text[48];
} ShownDecimals;
ShownDecimals show_decimals(double value, int decimals);

/* A bar to measure by, for an amount at a scale in mm a unit, and what it stands for: "5 m". */
void sketch_bar(Sketch *sketch, Point left, double scale, double amount, const char *unit, double points);

/* The largest of 1, 2 and 5 times a power of ten that is not above `most`, which is above 0. */
double round_down(double most);
