/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where a chart's parts lie on the page, in mm from its lower left corner. */
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
    double legend_top;   /* mm from the page's bottom, to the middle of the first row */
    int left_out, lost;
    FILE *script;
} ChartLayout;

/* Columns and rows of the legend, and how many rows of the table could not be drawn. */
void chart_lay_out_legend(ChartLayout *layout);

/* Writes the plot of the legend and the note below it, over the whole page. */
void chart_put_legend(const ChartLayout *layout);
