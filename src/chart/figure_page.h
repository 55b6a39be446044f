/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A figure in the making: panels, series and texts, laid out in mm from the page's lower left corner, in gnuplot's
   words. Texts are plain (chart_plain) or the program's own. */
#pragma once
#include "chart/chart_style.h"
#include "common/error.h"
#include "sketch/log_axis.h"
#include "sketch/page_width.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#define FIGURE_GREY "#606060"

typedef struct FigurePage {
    double width, height; /* mm; 0: there is nothing to draw */
    FILE *script;
    FILE *caption; /* one line */
    FILE *links;   /* SVG, in mm from the upper left corner; NULL: there can be none */
    FILE *plot;    /* what is to be plotted of the panel that is open */
    char *plot_text;
    size_t plot_size;
    int block;      /* number of the last data block */
    int points;     /* in that block */
    bool bars;      /* are what is in that block */
    bool beyond;    /* a value lies beyond its axis and is drawn at the edge */
    bool no_memory; /* a panel could not be written */
} FigurePage;

typedef struct FigureBox {
    double left, bottom, width, height; /* mm */
} FigureBox;

/* What a series looks like; and its name, for the legend. */
typedef struct FigureLook {
    const char *name;
    ChartStyle style;
    double line; /* width; 0: none */
    bool marks;
    double bar;   /* height of the bar that is its sample in the legend, mm; 0: no bar */
    bool upright; /* that bar */
} FigureLook;

/* Line and marks of chart_style(i); a grey dashed line without marks, for what is compared with. */
FigureLook figure_look(int i, const char *name);
FigureLook figure_dashed(const char *name);
/* One of several alike: a thin line. */
FigureLook figure_thin(FigureLook look);
/* Marks without a line. */
FigureLook figure_marks(FigureLook look);

void figure_begin(FigurePage *page, double width, double height);
void figure_end(FigurePage *page);

/* Opens a panel with a frame, its title above it. Then its axes, series and texts, then figure_panel_end(). */
void figure_panel(FigurePage *page, FigureBox box, const char *title);
void figure_panel_end(FigurePage *page);

/* A linear axis: tics of gnuplot's choice where `tics` is NULL, none where it is empty, else as in `set xtics TICS`;
   label NULL: none. */
void figure_linear(FigurePage *page, char letter, double low, double high, const char *tics, const char *label);

/* A series: its points, segments or bars, then its look; each covers those before. figure_gap() interrupts the line. A
   bar fills a rectangle: gnuplot 5.4 gives the start of a thick line a tip. What is NAN is left out; a series without
   points is not drawn. */
void figure_series(FigurePage *page);
void figure_point(FigurePage *page, double x, double y);
void figure_gap(FigurePage *page);
void figure_segment(FigurePage *page, double x0, double y0, double x1, double y1);
void figure_bar(FigurePage *page, double x0, double y0, double x1, double y1);
void figure_draw(FigurePage *page, const FigureLook *look);

/* An axis's label. */
void figure_axis_label(FigurePage *page, char letter, const char *label);

/* A text on the page at (x, y) mm: align is "left", "center" or "right". */
void figure_text(FigurePage *page, double x, double y, const char *align, double points, const char *text);

/* Makes a part of the page a link, in the SVG; `title` is shown where the pointer rests on it. */
void figure_link(FigurePage *page, FigureBox box, const char *target, const char *title);

/* Cuts a text to so many characters, the last three of them dots; most >= 3. */
void figure_cut(char *text, size_t most);

/* Opens a panel over the whole page, without a frame, its axes in mm. Of all panels the last, as the legend is. */
void figure_page_panel(FigurePage *page);

/* A legend in columns over [left, width - right], its first row's middle at `top` mm; of all panels the last. */
#define FIGURE_LEGEND_ROW 3.7 /* mm */
void figure_legend(FigurePage *page, const FigureLook *looks, int count, int columns, double left, double top);
