/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A chart in gnuplot's words. */
#pragma once
#include "chart/chart_data.h"

#include <stdbool.h>
#include <stdio.h>

/* As wide as a page of a paper. */
#define CHART_WIDTH 174.0 /* mm */
#define CHART_HEIGHT 85.0 /* mm */

/* Writes the script that draws the chart; title is plain text (chart_plain). False when memory is short. */
bool chart_script(const Chart *chart, const char *title, FILE *script);
