/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Looks of a chart's lines: no two alike in grey either. */
#pragma once

typedef struct ChartStyle {
    int symbol;         /* gnuplot's number */
    int filled;         /* symbol of the same shape, filled; 0: a cross, which has no inside */
    const char *colour; /* of lines and marks */
    const char *ink;    /* darker, of text */
    const char *dashes;
} ChartStyle;

/* Of line i of CHART_MAX_LINES. */
ChartStyle chart_style(int i);
