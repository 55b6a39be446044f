/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Labels of a chart's marks: at both ends of each line, where there is room. */
#pragma once
#include "chart/chart_layout.h"

/* The corners of the Pareto front: marks on the front by time, each with less error than all faster ones. Returns
   their number and fills order[panel->count] with their indices. */
int chart_pareto_corners(const ChartPanel *panel, int *order);

/* Draws the labels of a panel. False if out of memory. */
bool chart_draw_labels(const ChartLayout *layout, int panel, Sketch *sketch);
