/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page of boxes, lines, arrows and text, recorded as a list and then written as PNG, SVG or PDF.

     Sketch sketch;
     sketch_begin(&sketch, FIGURE_COLUMN_WIDTH, 40);
     sketch_line(&sketch, (Point){5, 5}, (Point){80, 5}, &pen);
     sketch_text(&sketch, (Point){5, 9}, &(TextStyle){8, TEXT_LEFT, INK, 0, false}, "%d boxes", count);
     bool done = sketch_write(&sketch, "page.svg", &output, &error);
     sketch_free(&sketch);

   Lengths in mm from the page's lower left corner. Later marks are above earlier ones; pictures are below and arrows
   and text above all else. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "pixels/png.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* mm: the page of a paper, and one of its two columns. */
#define FIGURE_PAGE_WIDTH 174.0
#define FIGURE_COLUMN_WIDTH 85.0

/* 0xRRGGBB, as in pictures/picture.h, where boxes are also blue and the network orange. ACCENT marks the point of a
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

typedef enum SketchMarkKind { MARK_IMAGE, MARK_PATH, MARK_TEXT } SketchMarkKind;

/* One element of the page. */
typedef struct SketchMark {
    SketchLayer layer;
    SketchMarkKind kind;
    Point at;     /* lower left corner of an image; reference point of a text */
    double width; /* mm, of an image */
    Image *image;
    Pen pen;
    bool closed;
    size_t first, count; /* of a path: range in the sketch's points */
    TextStyle style;
    size_t text;    /* offset in the sketch's texts */
    bool has_reads; /* what readers of a PDF's text get instead is at `reads` in the sketch's texts */
    size_t reads;
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

/* A line with a head at its end. */
void sketch_arrow(Sketch *sketch, Point from, Point to, uint32_t colour, double width);

/* A box in world coordinates, clipped to the window. */
void sketch_box(Sketch *sketch, const View *view, const Box *box, const Pen *pen);

/* One line of text, truncated to SKETCH_TEXT_SIZE - 1 bytes, vertically centred on `at`. */
void sketch_text(Sketch *sketch, Point at, const TextStyle *style, const char *format, ...) PRINTF_LIKE(4, 5);

/* A digit times 10 to a power ("2·10"; of 1, the power alone), aligned as the style says and its width in mm. Extracted
   from a PDF it reads "2·10⁻³". */
void sketch_power_of_ten(Sketch *sketch, Point at, const TextStyle *style, int digit, int power);
double sketch_power_width(double points, int digit, int power);

/* Breaks a text into lines ('\n') of at most this width in mm: at spaces and behind colons and commas, else behind
   other signs, else anywhere. Returns the number of lines. A text without room for its breaks ends there. */
int text_wrap(char *words, size_t size, double points, double width);

/* Draws such lines, the first at `first`, each below the one before. */
void sketch_lines(Sketch *sketch, Point first, const TextStyle *style, const char *lines);

/* mm, between such lines. */
double line_height(double points);

/* The font size at which a text is at most this wide, at most `points`. */
double text_points(const char *words, double points, double width);

/* A number as text with this many decimals: with a minus sign (U+2212), and without it for -0. */
typedef struct ShownDecimals {
    char text[48];
} ShownDecimals;
ShownDecimals show_decimals(double value, int decimals);

/* mm: between the end of a line or an arrow and the text that it belongs to; nearer it would be read as a minus
   sign. */
double gap_to_text(double points);

/* A scale bar for an amount at `scale` mm per unit, labelled for example "5 m"; and its width with the label, mm. */
void sketch_scale_bar(Sketch *sketch, Point left, double scale, double amount, const char *unit, double points);
double sketch_scale_bar_width(double scale, double amount, const char *unit, double points);

/* Writes a sketch to a file. The same sketch gives the same bytes, independent of machine, time and path. SVG and
   PDF are vector graphics, except for pictures; their text is text. */

#define SKETCH_DPI 300.0
#define SKETCH_DPI_MIN 50.0
#define SKETCH_DPI_MAX 1200.0
enum { SKETCH_MAX_PIXELS = 40000000 }; /* of a PNG; 160 MB in memory */

typedef struct SketchOutput {
    double dpi;       /* dots per inch of a PNG */
    bool transparent; /* without a white page */
    bool outlines;    /* SVG: text as outlines instead of text */
} SketchOutput;

typedef enum SketchFormat { SKETCH_PNG, SKETCH_SVG, SKETCH_PDF, SKETCH_FORMATS } SketchFormat;

/* From the ending of a path. ERROR_INPUT unless it is .png, .svg or .pdf. */
bool sketch_format(const char *path, SketchFormat *format, Error *error);

/* ERROR_INPUT if a page of this size in mm would exceed SKETCH_MAX_PIXELS. */
bool sketch_check_pixels(double width, double height, double dpi, Error *error);

/* ERROR_INPUT if a text or the title has a character that the font lacks (pixels/type.h); `where` names the origin. */
bool sketch_check_texts(const Sketch *sketch, const char *where, Error *error);

/* Writes the format given by the path's ending. The file appears complete or not at all. */
bool sketch_write(const Sketch *sketch, const char *path, const SketchOutput *output, Error *error);

/* Writes stem.png (SKETCH_DPI) and stem.svg, up to `last` SKETCH_PDF also stem.pdf, on white. */
bool sketch_draw(const Sketch *sketch, const char *stem, SketchFormat last, Error *error);
