/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Styles of a chart's lines, all distinguishable in grey. */
#pragma once
#include <stdio.h>

#define PARETO_COLOUR "#C8C8C8"

typedef struct ChartStyle {
    int symbol;         /* gnuplot point type */
    int filled;         /* the filled variant of the symbol; 0: none, a cross */
    const char *colour; /* of lines and marks */
    const char *ink;    /* darker, of text */
    const char *dashes;
} ChartStyle;

/* The style of line i of CHART_MAX_LINES. */
ChartStyle chart_style(int i);

/* Write an element of gnuplot's plot command for the data block $<data><number>: a line through its points, or their
   marks. */
void chart_write_line(FILE *script, char data, int number, const ChartStyle *style);
void chart_write_marks(FILE *script, char data, int number, const ChartStyle *style);
