/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Labels of a chart's marks: at both ends of each line, where there is room. */
#pragma once
#include "chart/chart_data.h"
#include "sketch/log_axis.h"

#include <stdio.h>

/* Sizes of text and marks on the page. */
#define LABEL_POINTS 6.5
#define MARK_RADIUS 0.85 /* mm */
#define RING_RADIUS 2.2  /* mm */

/* The corners of the Pareto front: marks on the front by time, each with less error than all faster ones. Returns
   their number and fills order[panel->count] with their indices. */
int chart_pareto_corners(const ChartPanel *panel, int *order);

/* Writes gnuplot's `set label` commands for a panel with these axes. False if out of memory. */
bool chart_write_labels(const ChartPanel *panel, const Chart *chart, const LogAxis *x, const LogAxis *y, FILE *script);
