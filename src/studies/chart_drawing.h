/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A chart in progress: panels, names, the picture. */
#pragma once
#include "base/base.h"
#include "figures/labels.h"
#include "figures/plot.h"
#include "figures/sketch.h"
#include "studies/chart_data.h"
#include "studies/chart_plot.h"

#include <stdbool.h>

#define CHART_NAME_POINTS 8.0
#define CHART_SMALL_POINTS 6.5
#define CHART_RING_RADIUS 1.9  /* mm: around the baseline */
#define CHART_GREY_RADIUS 0.42 /* mm: of grey marks */
#define CHART_GREY_INK 0x666E78u

typedef struct ChartDrawing {
    const Chart *chart;
    const ChartPanel *panel;
    const PlotPanel *plot;
    Sketch *sketch;
    bool bare;                              /* names alone: there is no room for what is beside them */
    LabelField tried;                       /* the field before a first try */
    LabelField field;                       /* its first two segments are the lines through the baseline */
    int marks;                              /* the field's boxes of marks; those of labels follow */
    bool *named;                            /* [line] */
    const ChartMark *told[CHART_MAX_LINES]; /* in this panel: the mark that a line's name tells of, or NULL */
} ChartDrawing;

static inline const ChartLine *chart_line_of(const ChartDrawing *drawing, const ChartMark *mark) {
    return &drawing->chart->lines[mark->line];
}

static inline bool chart_is_coloured(const ChartDrawing *drawing, const ChartMark *mark) {
    return chart_line_of(drawing, mark)->rank == CHART_COLOURED;
}

static inline Point chart_place(const ChartDrawing *drawing, const ChartMark *mark) {
    return plot_place(drawing->plot, mark->us, mark->error);
}

PlotStyle chart_line_style(const ChartLine *line);

/* The mark that the others are compared with; NULL: not in the panel. */
const ChartMark *chart_find_baseline(const ChartPanel *panel);

/* Begins the field with the lines through the baseline. */
void chart_find_cross(ChartDrawing *drawing);

/* Draws the names of all lines for which there is room beside marks and curves, settings of coloured ones, and the
   lines through the baseline. */
void chart_draw_names(ChartDrawing *drawing, int panel);
