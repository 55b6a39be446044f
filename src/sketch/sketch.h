/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page of boxes, lines, arrows and text, recorded as a list and then written as PNG, SVG or PDF (sketch_files.h).
   Lengths in mm from the page's lower left corner. Later marks are above earlier ones; pictures are below and arrows
   and text above all else. */
#pragma once
#include "collision/manifold.h"
#include "common/error.h"
#include "common/point.h"
#include "image/image.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* 0xRRGGBB, as in picture/style.h, where boxes are also blue and the network orange. ACCENT marks the point of a
   figure: black stands out in grey prints and beside Okabe and Ito's colours. */
#define BOX_COLOUR 0x0072B2u
#define BOX_INK 0x00395Cu
#define NETWORK_COLOUR 0xE69F00u
#define NETWORK_INK 0x7A4F00u
#define ACCENT 0x000000u
#define NO_COLOUR UINT32_MAX

#define LINE_UNIT 0.17 /* mm */

/* The style of a shape. */
typedef struct Pen {
    uint32_t fill; /* NO_COLOUR: not filled */
    double opacity;
    uint32_t line;      /* NO_COLOUR: no line */
    double width;       /* of the line, in LINE_UNIT */
    const char *dashes; /* "(6,5)": dash and gap, up to two of each, in LINE_UNIT; NULL: solid. Must outlive the
                           sketch */
} Pen;

static inline Pen pen_line(uint32_t line, double width, const char *dashes) {
    return (Pen){NO_COLOUR, 1, line, width, dashes};
}

static inline Pen pen_fill(uint32_t fill, double opacity, uint32_t line) {
    return (Pen){fill, opacity, line, 1.2, NULL};
}

/* A window of the page onto the world: world point `center` is in its middle. */
typedef struct View {
    Point low, high; /* corners of the window, mm */
    Point center;    /* m */
    double scale;    /* mm per metre */
} View;

Point view_place(const View *view, Vec2 position);

enum { SKETCH_TEXT_SIZE = 2048 };

typedef enum TextAlign { TEXT_LEFT, TEXT_CENTER, TEXT_RIGHT } TextAlign;

typedef struct TextStyle {
    double points; /* font size */
    TextAlign align;
    uint32_t colour;
    double degrees; /* rotation, counter-clockwise */
    bool halo;      /* with a white outline, to be readable on a picture */
} TextStyle;

/* From bottom to top. */
typedef enum SketchLayer { LAYER_PICTURES, LAYER_SHAPES, LAYER_ARROWS, LAYER_TEXTS, SKETCH_LAYERS } SketchLayer;

typedef enum SketchMarkKind { MARK_IMAGE, MARK_PATH, MARK_TEXT, MARK_LINK } SketchMarkKind;

/* One element of the page. */
typedef struct SketchMark {
    SketchLayer layer;
    SketchMarkKind kind;
    Point at;     /* lower left corner of an image; reference point of a text */
    double width; /* mm, of an image */
    Image *image;
    Pen pen;
    bool closed;
    size_t first, count; /* of a path or a link's area: range in the sketch's points */
    TextStyle style;
    size_t text;    /* offset in the sketch's texts; of a link: its target */
    bool has_reads; /* what readers of a PDF's text get instead is at `reads` in the sketch's texts */
    size_t reads;   /* of a link: its tooltip */
} SketchMark;

typedef struct Sketch {
    double width, height;         /* mm */
    char title[SKETCH_TEXT_SIZE]; /* of SVG and PDF files; "": none */
    SketchMark *marks;
    Point *points;
    char *texts;
    size_t mark_count, mark_capacity, point_count, point_capacity, text_size, text_capacity;
    bool failed; /* out of memory: the sketch is incomplete */
} Sketch;

/* Starts a sketch; free it with sketch_free(). The title stays empty. */
void sketch_begin(Sketch *sketch, double width, double height);
void sketch_free(Sketch *sketch);

/* A copy of a picture with its alpha, lower left corner at `low`, `width` mm wide. */
void sketch_image(Sketch *sketch, const Image *image, Point low, double width);

/* An open line through points, or a closed shape. */
void sketch_path(Sketch *sketch, const Point *points, int count, const Pen *pen);
void sketch_shape(Sketch *sketch, const Point *points, int count, const Pen *pen);
void sketch_line(Sketch *sketch, Point from, Point to, const Pen *pen);
void sketch_rectangle(Sketch *sketch, Point low, Point high, const Pen *pen);
void sketch_dot(Sketch *sketch, Point at, double radius, const Pen *pen);

/* A line with a head at its end or at both ends. */
typedef enum ArrowHeads { HEAD_AT_END, HEADS_AT_BOTH } ArrowHeads;
void sketch_arrow(Sketch *sketch, Point from, Point to, ArrowHeads heads, uint32_t colour, double width);

/* A box in world coordinates, clipped to the window. */
void sketch_box(Sketch *sketch, const View *view, const Box *box, const Pen *pen);

/* One line of text, truncated to SKETCH_TEXT_SIZE - 1 bytes, vertically centred on `at`. */
void sketch_text(Sketch *sketch, Point at, const TextStyle *style, const char *format, ...) PRINTF_LIKE(4, 5);

/* A digit times 10 to a power ("2·10"; of 1, the power alone), aligned as the style says and its width in mm. Extracted from
   a PDF it reads "2·10⁻³". */
void sketch_power_of_ten(Sketch *sketch, Point at, const TextStyle *style, int digit, int power);
double sketch_power_width(double points, int digit, int power);

/* Makes an area a link with a tooltip, in SVG files only. */
void sketch_link(Sketch *sketch, Point low, Point high, const char *target, const char *title);

/* Shortens a text to a width in mm, with an ellipsis. */
void text_fit(char *words, size_t size, double points, double width);

/* A number as text with this many decimals: with a minus sign (U+2212), and without it for -0. */
typedef struct ShownDecimals {
    char text[48];
} ShownDecimals;
ShownDecimals show_decimals(double value, int decimals);

/* A scale bar for an amount at `scale` mm per unit, labelled for example "5 m". */
void sketch_scale_bar(Sketch *sketch, Point left, double scale, double amount, const char *unit, double points);

/* The largest 1, 2 or 5 times a power of ten that is at most `most`; most > 0. */
double round_down(double most);
