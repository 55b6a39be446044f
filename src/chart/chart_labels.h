/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Labels of a chart's marks: the ends of each line, where there is room. */
#pragma once
#include "chart/chart_data.h"
#include "sketch/log_axis.h"

#include <stdio.h>

/* Sizes of type and marks on the page. */
#define LABEL_POINTS 6.5
#define MARK_RADIUS 0.85 /* mm */
#define RING_RADIUS 2.2  /* mm */

/* Corners of the staircase of what nobody beats: of the marks on the front, by time, those with less error than all
   faster ones. Returns how many; order[panel->count] tells which. */
int chart_front(const ChartPanel *panel, int *order);

/* Writes gnuplot's `set label`s for a panel with these axes. False when memory is short. */
bool chart_put_labels(const ChartPanel *panel, const Chart *chart, const LogAxis *x, const LogAxis *y, FILE *script);
