/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Looks of a chart's lines: no two alike in grey either. */
#pragma once
#include <stdio.h>

#define FRONT_COLOUR "#C8C8C8"

typedef struct ChartStyle {
    int symbol;         /* gnuplot's number */
    int filled;         /* symbol of the same shape, filled; 0: a cross, which has no inside */
    const char *colour; /* of lines and marks */
    const char *ink;    /* darker, of text */
    const char *dashes;
} ChartStyle;

/* Of line i of CHART_MAX_LINES. */
ChartStyle chart_style(int i);

/* Writes what gnuplot's plot command needs for the data block $<data><number>: a line through its points, or their
   marks. */
void chart_put_line(FILE *script, char data, int number, const ChartStyle *style);
void chart_put_marks(FILE *script, char data, int number, const ChartStyle *style);
