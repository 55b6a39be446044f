/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layout of a chart, in mm from the page's lower left corner. */
#pragma once
#include "chart/chart_data.h"
#include "sketch/log_axis.h"

#include <stdio.h>

/* mm */
#define LEFT_MARGIN 16.5
#define RIGHT_MARGIN 3.5 /* half of "1000" below an axis that ends there */
#define LEGEND_ROW 3.7
#define FOOT_ROW 3.4

typedef struct ChartLayout {
    const Chart *chart;
    const char *title;
    LogAxis x[CHART_PANELS], y;
    int columns, rows;   /* of the legend */
    double column_width; /* mm */
    double legend_top;   /* mm, middle of the first row */
    int foot_rows;       /* of the note below the legend */
    FILE *script;
} ChartLayout;

/* Computes columns and rows of the legend and of the note below it. */
void chart_lay_out_legend(ChartLayout *layout);

/* Writes the legend and the note below it, as a plot over the whole page. */
void chart_write_legend(const ChartLayout *layout);
