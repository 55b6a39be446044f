/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The Pareto front of speed and accuracy: the rows that no other row dominates. */
#pragma once
#include "study/chart_csv.h"

/* m/s: smaller errors count as equal. */
#define PARETO_RESOLUTION 1e-4

/* True if a is certainly faster than b and not less accurate: its upper quartile of time is below b's lower quartile,
   and its mean error is at most b's, or below PARETO_RESOLUTION. Rows whose quartile intervals overlap are not ordered.
   Rows of different scenes, protocols or phases are not compared. Rows without quartiles of time or without an error,
   and rows of baselines and of the reference (common/method_description.h), neither dominate nor are dominated. Rows of
   unknown methods compete. */
bool pareto_dominates(const ChartRow *a, const ChartRow *b);

/* on_front[count]: rows that compete and that no other row dominates. */
void pareto_mark(const ChartRow *rows, int count, bool *on_front);
