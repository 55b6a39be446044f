/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Logarithmic axes that fit what is drawn. */
#pragma once
#include "chart/figure_page.h"

/* Least and most of the values above 0. */
typedef struct FigureRange {
    double least, most;
} FigureRange;

FigureRange figure_range(void);
void figure_widen(FigureRange *range, double value); /* NAN and what is not above 0 do not count */

typedef struct FigureAxis {
    LogAxis log;
    double least; /* where the tics begin */
    double zero;  /* where 0 is drawn, left of them; or 0 */
} FigureAxis;

/* An axis for the range within [lowest, highest], one decade long at least. With_zero: 0 has its place, too. */
FigureAxis figure_axis(FigureRange range, double lowest, double highest, bool with_zero);

/* Writes a panel's axis; label NULL: without numbers, either. */
void figure_log(FigurePage *page, char letter, const FigureAxis *axis, const char *label);

/* Where a value is drawn: within the axis. */
double figure_on(FigurePage *page, const FigureAxis *axis, double value);
