/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plots on a sketch: axes, panels, series and legends; and whole figures of them.

     PlotPanel panel = {.box = {13, 17, 70, 40}, .x = plot_linear_axis(0, 2, "s"), .y = plot_log_axis(1e-6, 1, "m")};
     plot_panel_place(&panel);
     plot_panel_draw(&sketch, &panel);
     plot_mark(&sketch, plot_place(&panel, 0.5, 1e-3), &style, MARK_RADIUS, 1.6);

   plot_draw() draws a whole figure whose panels, looks and points are data. */
#pragma once
#include "base/base.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "pictures/colours.h"

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

/* Lines (text_wrap), the first at `at`. */
void plot_text(Sketch *sketch, Point at, TextAlign align, double points, const char *text);

#define LEGEND_ROW 3.7
#define LEGEND_SAMPLE 8.0
#define LEGEND_GAP 1.2 /* between sample and name */
#define LEGEND_POINTS 7.5

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
    double legend_left, legend_top; /* mm: the middle of its first row; it has the series with points */
    const char *caption;
} PlotSpec;

enum { PLOT_SERIES = 24 };

/* False if out of memory; the error names `what`. */
bool plot_draw(PlotPage *page, const PlotSpec *spec, const char *what, Error *error);
