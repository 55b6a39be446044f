/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A figure of plots with its caption; and the one function that draws plots which differ in their data only. */
#pragma once
#include "sketch/page_width.h"
#include "sketch/plot.h"

enum { PLOT_CAPTION_SIZE = 2048 };

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

/* Each series may have a point for each of the rows, in each panel. The first series is on top. */
typedef struct PlotSpec {
    const void *of;       /* handed to the functions */
    double width, height; /* mm, of the page */
    int panels, series, rows;
    void (*panel)(const void *of, int panel, PlotPanel *out); /* *out is zero before; width 0: left out */
    PlotLook (*look)(const void *of, int series);
    bool (*point)(const void *of, int panel, int series, int row, PlotPoint *out); /* false: none */
    int legend_columns;
    double legend_left, legend_top; /* as of plot_legend(); the legend has the series with points */
    const char *caption;
} PlotSpec;

enum { PLOT_SERIES = 24 };

/* False if out of memory; the error names `what`. */
bool plot_draw(PlotPage *page, const PlotSpec *spec, const char *what, Error *error);
