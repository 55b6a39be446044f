/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes charts as gnuplot scripts. */
#pragma once
#include "chart/chart_data.h"
#include "sketch/page_width.h"

#include <stdbool.h>
#include <stdio.h>

#define CHART_WIDTH FIGURE_PAGE_WIDTH
#define CHART_HEIGHT 100.0 /* mm */

/* Writes the script of a chart; `title` must be safe (chart_plain). False if out of memory. */
bool chart_script(const Chart *chart, const char *title, FILE *script);

/* Where a mark is drawn: shares of the page's width and height, from its upper left corner. */
void chart_mark_place(const Chart *chart, int panel, const ChartMark *mark, double *left, double *top);

extern const char *const chart_panel_titles[CHART_PANELS];
