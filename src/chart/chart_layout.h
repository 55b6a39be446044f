/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layout of a chart, in mm from the page's lower left corner: two panels side by side and a legend below. */
#pragma once
#include "chart/chart_data.h"
#include "sketch/page_width.h"
#include "sketch/plot.h"

#define CHART_WIDTH FIGURE_PAGE_WIDTH
#define CHART_HEIGHT 100.0
#define LEFT_MARGIN 16.5
#define RIGHT_MARGIN 3.5 /* half of "1000" below an axis that ends there */
#define FOOT_ROW 3.4

#define LABEL_POINTS 6.5
#define RING_RADIUS 2.2 /* mm: around a setting as shipped */

enum { CHART_NOTES = 4 };

typedef struct ChartNote {
    char text[SKETCH_TEXT_SIZE]; /* one line */
} ChartNote;

typedef struct ChartLayout {
    const Chart *chart;
    PlotPanel panels[CHART_PANELS];
    int columns, rows; /* of the legend */
    double legend_top; /* mm, middle of the first row */
    int foot_rows;     /* notes below the legend, from the bottom */
    ChartNote notes[CHART_NOTES];
} ChartLayout;

ChartLayout chart_lay_out(const Chart *chart);

/* Computes columns and rows of the legend, and the notes below it. */
void chart_lay_out_legend(ChartLayout *layout);

void chart_draw_legend(const ChartLayout *layout, Sketch *sketch);

/* The corners of the Pareto front: marks on the front by time, each with less error than all faster ones. Returns
   their number and fills order[panel->count] with their indices. */
int chart_pareto_corners(const ChartPanel *panel, int *order);

/* Draws the labels of a panel's marks: at both ends of each line, where there is room. False if out of memory. */
bool chart_draw_labels(const ChartLayout *layout, int panel, Sketch *sketch);

/* Where a mark is drawn: shares of the page's width and height, from its upper left corner. */
void chart_mark_place(const Chart *chart, int panel, const ChartMark *mark, double *left, double *top);

extern const char *const chart_panel_titles[CHART_PANELS];
