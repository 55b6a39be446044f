/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A chart in gnuplot's words. */
#pragma once
#include "chart/chart_data.h"
#include "sketch/page_width.h"

#include <stdbool.h>
#include <stdio.h>

#define CHART_WIDTH FIGURE_PAGE_WIDTH
#define CHART_HEIGHT 85.0 /* mm */

/* Writes the script that draws the chart; title is plain text (chart_plain). False when memory is short. */
bool chart_script(const Chart *chart, const char *title, FILE *script);
