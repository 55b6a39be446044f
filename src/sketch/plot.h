/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Panels, series and legends of plots in a sketch. Lengths in mm from the page's lower left corner. */
#pragma once
#include "sketch/plot_axis.h"
#include "sketch/plot_style.h"

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
    const char *title;
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

void plot_text(Sketch *sketch, Point at, TextAlign align, double points, const char *text);

/* A legend in columns over [left, page width], the middle of its first row at `top`. Looks without a name are left out. */
#define LEGEND_ROW 3.7
#define LEGEND_SAMPLE 8.0
#define LEGEND_GAP 1.2 /* between sample and name */
#define LEGEND_POINTS 7.5
void plot_legend(Sketch *sketch, const PlotLook *looks, int count, int columns, double left, double top);
