/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A pen for pages in mm: paths, text and pictures as PDF, SVG and PNG; on it axes, series and legends of plots. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "pictures/colours.h"
#include "pixels/png.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* The axes of plots: from values to places on the page, and ticks at round numbers. */

/* The range of the values above 0. */
typedef struct PlotRange {
    double least, most;
} PlotRange;

PlotRange plot_range(void);
void plot_range_include(PlotRange *range, double value); /* ignores NaN, infinite values and those not above 0 */

typedef struct PlotTick {
    double value;
    bool minor;       /* short, without a number */
    char text[48];    /* may have two lines */
    int digit, power; /* digit > 0: the number is digit · 10^power instead of the text */
} PlotTick;

enum { PLOT_TICKS = 512 };

typedef struct PlotTicks {
    int count;
    PlotTick items[PLOT_TICKS];
} PlotTicks;

typedef enum PlotScale {
    PLOT_LINEAR,
    PLOT_LOG,
    PLOT_DOUBLING /* logarithmic, with ticks at powers of two */
} PlotScale;

typedef struct PlotAxis {
    PlotScale scale;
    double low, high;       /* values at the ends; high may be less; equal: all values are in the middle */
    double from, to;        /* mm: places of the ends on the page */
    double least;           /* no ticks below */
    double zero;            /* of a logarithmic axis: the value at whose place 0 is; 0: none */
    bool powers;            /* numbers are powers of ten */
    bool outside;           /* ticks are outside the frame */
    const PlotTicks *ticks; /* NULL: chosen */
    const char *label;      /* NULL: neither label nor numbers; "": numbers only */
} PlotAxis;

PlotAxis plot_linear_axis(double low, double high, const char *label);

/* For values in [least, most], both above 0, with padding on both sides and at least one decade, so that it has
   ticks. */
PlotAxis plot_log_axis(double least, double most, const char *label);

/* The same for a range clamped to [lowest, highest]. with_zero: adds a place for 0, left of the ticks. */
PlotAxis plot_range_axis(PlotRange range, double lowest, double highest, bool with_zero, const char *label);

/* mm on the page. */
double plot_axis_place(const PlotAxis *axis, double value);

/* A value that is on the axis. *beyond becomes true if it is another one; infinite values stand for the ends. */
double plot_axis_clamp(const PlotAxis *axis, double value, bool *beyond);

void plot_tick_add(PlotTicks *ticks, double value, bool minor, const char *text);

/* mm: of a tick's number. */
double plot_tick_width(const PlotTick *tick, double points);

/* As many ticks at round numbers as have room for numbers of this size. across: along the page's width. */
void plot_ticks_choose(PlotTicks *ticks, const PlotAxis *axis, double points, bool across);

/* A page of boxes, lines, arrows and text, recorded as a list and then written as PNG, SVG or PDF.
   Lengths in mm from the page's lower left corner. Later marks are above earlier ones; pictures are below and arrows
   and text above all else. */

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

/* A scale bar for an amount at `scale` mm per unit, labelled for example "5 m"; and its width with the label, mm. */
void sketch_scale_bar(Sketch *sketch, Point left, double scale, double amount, const char *unit, double points);
double sketch_scale_bar_width(double scale, double amount, const char *unit, double points);

/* Styles of lines and marks, all distinguishable in grey. */

#define PLOT_GREY 0x606060u

/* Continues MethodSymbol. */
enum { PLOT_PLUS = METHOD_SYMBOLS, PLOT_CROSS, PLOT_STAR, PLOT_UPRIGHT, PLOT_LEVEL, PLOT_SYMBOLS };

typedef struct PlotStyle {
    int symbol; /* a MethodSymbol, or one of the crosses and bars above */
    bool open;
    uint32_t colour;    /* of lines and marks */
    uint32_t ink;       /* darker, of text */
    const char *dashes; /* as of a Pen */
} PlotStyle;

/* The style of series i, which is no method. */
PlotStyle plot_style(int i);

/* The style of a series that is a method: further settings of one have a shade, the first with an open symbol, others
   with other symbols. */
PlotStyle plot_method_style(const RunColours *colours);

/* A mark of this radius in mm; the lines of open symbols and crosses are `line` wide (LINE_UNIT). */
void plot_mark(Sketch *sketch, Point at, const PlotStyle *style, double radius, double line);

/* The marks of a series. White ones below, slightly larger, separate them from the lines and marks of others. */
#define MARK_RADIUS 0.72 /* mm */
void plot_marks(Sketch *sketch, const Point *points, int count, const PlotStyle *style);

/* Panels, series and legends of plots in a sketch. Lengths in mm from the page's lower left corner. */

typedef struct PlotBox {
    double left, bottom, width, height;
} PlotBox;

/* Panels of equal size in rows, counted from the upper left one. */
typedef struct PlotGrid {
    double width, height;            /* of the page */
    double left, right, bottom, top; /* margins around the panels */
    int columns, rows;
    double gap, row_gap;
} PlotGrid;

PlotBox plot_grid_box(const PlotGrid *grid, int place);

typedef struct PlotPanel {
    PlotBox box;
    const char *title; /* may have lines (text_wrap) */
    PlotAxis x, y;
    double points; /* size of labels; numbers are slightly smaller; 0: 8 */
    bool guides;   /* a pale line at each number of the y axis */
} PlotPanel;

/* Puts the axes' ends to the edges of the box. */
void plot_panel_place(PlotPanel *panel);

/* The place of a value. */
Point plot_place(const PlotPanel *panel, double x, double y);

/* Draws frame, ticks, numbers, labels and title of a placed panel. */
void plot_panel_draw(Sketch *sketch, const PlotPanel *panel);

/* mm: room for ticks, numbers and the label left of a panel whose numbers are powers of ten, and below it. */
double plot_left_margin(double points);
double plot_bottom_margin(double points);

/* How a series is drawn, and its name in the legend; NULL: not in the legend. */
typedef struct PlotLook {
    const char *name;
    PlotStyle style;
    double line; /* width (LINE_UNIT); 0: no line */
    bool marks;
    bool stems;   /* upright lines to the marks instead of a line through them */
    bool band;    /* an area between two corners */
    bool medians; /* through the medians of the points at each x */
    bool seeds;   /* the same above a thin line for each group of points */
    bool above;   /* above the other series */
} PlotLook;

/* Line and marks of plot_style(i); marks alone; a dashed grey line without marks, for a baseline; a thin pale line. */
PlotLook plot_look(int i, const char *name);
PlotLook plot_look_marks(int i, const char *name);
PlotLook plot_look_dashed(const char *name);
PlotLook plot_look_guide(void);

/* The same series as a thin line without marks, for one of several equivalent ones. */
PlotLook plot_look_thin(PlotLook look);

/* A line through points of the page, and marks on them; a point that is NaN interrupts the line. */
void plot_line(Sketch *sketch, const Point *points, int count, const PlotLook *look);

/* Lines (text_wrap), the first at `at`. */
void plot_text(Sketch *sketch, Point at, TextAlign align, double points, const char *text);

/* A legend in columns over [left, page width], the middle of its first row at `top`. Looks without a name are left
   out. */
#define LEGEND_ROW 3.7
#define LEGEND_SAMPLE 8.0
#define LEGEND_GAP 1.2 /* between sample and name */
#define LEGEND_POINTS 7.5
void plot_legend(Sketch *sketch, const PlotLook *looks, int count, int columns, double left, double top);

/* Places labels beside marks without covering anything. All lengths in mm on the page. */

typedef struct PageBox {
    double left, bottom, right, top;
} PageBox;

typedef struct Segment {
    double x0, y0, x1, y1;
} Segment;

enum { LABEL_MAX_BOXES = 1024, LABEL_MAX_SEGMENTS = 2048 };

/* Everything already drawn. */
typedef struct LabelField {
    PageBox frame; /* labels stay inside */
    int box_count, segment_count;
    int crossable;                        /* the first boxes, which lines to labels may cross if they may cross lines */
    PageBox boxes[LABEL_MAX_BOXES];       /* marks and labels, never covered */
    Segment segments[LABEL_MAX_SEGMENTS]; /* lines, crossed only by labels that must be placed */
} LabelField;

/* Beyond the limits boxes and segments are ignored, and labels may cover them. */
void label_add_box(LabelField *field, PageBox box);
void label_add_segment(LabelField *field, Segment segment);

/* Whether a label here covers no box and crosses no line. */
bool label_fits(const LabelField *field, const PageBox *box);

/* Finds the box for a label of this size near (x, y), at least `distance` away: the nearest that covers no box and
   crosses no line. False if there is none; with `must`, the one that crosses the fewest lines. Adds the box to the
   field. */
bool label_place(LabelField *field, double x, double y, double distance, double width, double height, bool must,
                 PageBox *place);

/* A label of this size for the mark at (x, y), whose radius is `clear`. */
typedef struct LabelWish {
    double x, y, clear;
    double nearest, farthest; /* mm, from the mark to the label */
    double width, height;
    bool left;   /* try the left before the right */
    bool across; /* the line to the label may cross others, and crossable boxes */
    /* a line from beside ends at the lower corner and goes on below, not to be read as a number's minus sign */
    bool shelf;
} LabelWish;

/* Finds the nearest free place for a label, to which a straight line from its mark crosses nothing that is drawn;
   *leader is that line, from the mark's edge to the label, and *led whether it is long enough to be drawn. Adds label
   and line to the field. False if there is no place. */
bool label_place_led(LabelField *field, const LabelWish *wish, PageBox *place, Segment *leader, bool *led);

/* mm: the page of a paper, and one of its two columns. */
#define FIGURE_PAGE_WIDTH 174.0
#define FIGURE_COLUMN_WIDTH 85.0

/* A figure of plots with its caption; and the one function that draws plots which differ in their data only. */

enum { PLOT_CAPTION_SIZE = 16384 };

/* Initialise with zeros; free with plot_page_free(). */
typedef struct PlotPage {
    Sketch sketch;                   /* width 0: nothing to draw */
    char caption[PLOT_CAPTION_SIZE]; /* one line */
} PlotPage;

void plot_page_free(PlotPage *page);

/* Writes folder/prefixNAME.png and .svg, and the caption as .txt. Does nothing for width 0. */
bool plot_page_write(PlotPage *page, const char *folder, const char *prefix, const char *name, Error *error);

/* A point of a series, in the units of its panel. Infinite values stand for the axis's ends, NaN for no point. */
typedef struct PlotPoint {
    double x, y;
    double group; /* the line is interrupted where it changes */
} PlotPoint;

/* A line across the panel: of a series, the points 0 and 1 are its ends; false for others. */
bool plot_level(PlotPoint *out, int i, double y);
bool plot_upright(PlotPoint *out, int i, double x);

/* Each series may have a point for each of the rows, in each panel. The first series is on top. */
typedef struct PlotSpec {
    double width, height;  /* mm: of the page */
    PlotPanel *panels;     /* [panel_count] with their boxes, in which plot_draw() places the axes; width 0: left out */
    const PlotLook *looks; /* [series] */
    int panel_count, series, rows;
    bool (*point)(const void *of, int panel, int series, int row, PlotPoint *out); /* false: none */
    const void *of;                                                                /* handed to point */
    int legend_columns;
    double legend_left, legend_top; /* as of plot_legend(); the legend has the series with points */
    const char *caption;
} PlotSpec;

enum { PLOT_SERIES = 24 };

/* False if out of memory; the error names `what`. */
bool plot_draw(PlotPage *page, const PlotSpec *spec, const char *what, Error *error);

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
