/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes the gnuplot script of a figure: panels, series and texts, laid out in mm from the page's lower left corner.
   Texts must be safe (chart_plain) or constant. */
#pragma once
#include "chart/chart_style.h"
#include "common/error.h"
#include "sketch/log_axis.h"
#include "sketch/page_width.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#define GNUPLOT_GREY "#606060"

typedef struct GnuplotPage {
    double width, height; /* mm; width 0: nothing to draw */
    FILE *script;
    FILE *caption; /* one line */
    FILE *links;   /* SVG, in mm from the upper left corner; NULL: no links */
    FILE *plot;    /* plot command of the open panel */
    char *plot_text;
    size_t plot_size;
    int block;      /* number of the current data block */
    int points;     /* points in that block */
    bool bars;      /* the block contains bars */
    bool beyond;    /* a value was clamped to its axis */
    bool no_memory; /* out of memory in a panel */
} GnuplotPage;

typedef struct GnuplotBox {
    double left, bottom, width, height; /* mm */
} GnuplotBox;

/* The style of a series, and its name in the legend. */
typedef struct GnuplotLook {
    const char *name;
    ChartStyle style;
    double line; /* width; 0: no line */
    bool marks;
    double bar;   /* mm, height of a bar as sample in the legend; 0: no bar */
    bool upright; /* orientation of that bar */
} GnuplotLook;

/* Line and marks of chart_style(i); or a grey dashed line without marks, for a baseline. */
GnuplotLook gnuplot_look(int i, const char *name);
GnuplotLook gnuplot_look_dashed(const char *name);
/* A thin line, for one of several equivalent series. */
GnuplotLook gnuplot_look_thin(GnuplotLook look);
/* Marks without a line. */
GnuplotLook gnuplot_look_marks(GnuplotLook look);

void gnuplot_page_begin(GnuplotPage *page, double width, double height);
void gnuplot_page_end(GnuplotPage *page);

/* Opens a panel with a frame and a title above; add axes, series and texts, then call gnuplot_panel_end(). */
void gnuplot_panel_begin(GnuplotPage *page, GnuplotBox box, const char *title);
void gnuplot_panel_end(GnuplotPage *page);

/* A linear axis. tics NULL: chosen by gnuplot; empty: none; otherwise as in `set xtics TICS`. label NULL: none. */
void gnuplot_linear_axis(GnuplotPage *page, char letter, double low, double high, const char *tics, const char *label);

/* A series: its points, segments or bars, then its style; later series are on top. gnuplot_gap() interrupts the
   line. Bars are filled rectangles, as gnuplot 5.4 draws thick lines with a pointed start. NaN points are left out,
   and so is a series without points. */
void gnuplot_series_begin(GnuplotPage *page);
void gnuplot_point(GnuplotPage *page, double x, double y);
void gnuplot_gap(GnuplotPage *page);
void gnuplot_segment(GnuplotPage *page, double x0, double y0, double x1, double y1);
void gnuplot_bar(GnuplotPage *page, double x0, double y0, double x1, double y1);
void gnuplot_series_end(GnuplotPage *page, const GnuplotLook *look);

/* Sets an axis label. */
void gnuplot_axis_label(GnuplotPage *page, char letter, const char *label);

/* A text at (x, y) mm on the page; align is "left", "center" or "right". */
void gnuplot_text(GnuplotPage *page, double x, double y, const char *align, double points, const char *text);

/* The same in front of the series, in a colour, turned counter-clockwise. */
typedef struct GnuplotInk {
    const char *colour; /* "white" */
    double degrees;
} GnuplotInk;
void gnuplot_text_in(GnuplotPage *page, double x, double y, const char *align, double points, const char *text,
                     GnuplotInk ink);

/* Makes an area of the SVG a link; `title` is its tooltip. */
void gnuplot_link(GnuplotPage *page, GnuplotBox box, const char *target, const char *title);

/* Truncates a text to `most` >= 3 characters, ending in "...". */
void gnuplot_truncate(char *text, size_t most);

/* Opens a frameless panel over the whole page, with axes in mm; must be the last panel. */
void gnuplot_page_panel_begin(GnuplotPage *page);

/* A legend in columns over [left, width - right], the middle of its first row at `top` mm. Opens the last panel. */
#define GNUPLOT_LEGEND_ROW 3.7 /* mm */
void gnuplot_legend(GnuplotPage *page, const GnuplotLook *looks, int count, int columns, double left, double top);
