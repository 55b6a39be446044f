/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Styles of lines and marks, all distinguishable in grey. */
#pragma once
#include "common/method_description.h"

#include <stdio.h>

#define PARETO_COLOUR "#C8C8C8"

typedef struct ChartStyle {
    int symbol;         /* gnuplot point type */
    int filled;         /* the filled variant of the symbol; 0: none, a cross */
    const char *colour; /* of lines and marks */
    const char *ink;    /* darker, of text */
    const char *dashes;
} ChartStyle;

/* The style of series i, which is no method. */
ChartStyle chart_style(int i);

/* The styles of `count` series, each of a method (NULL: unknown), all different: colour and symbol of its description.
   Several series of one method have one colour, the second with an open symbol, further ones with others. */
void chart_method_styles(const MethodDescription *const *methods, int count, ChartStyle *styles);

/* "#0072B2": the colour of a method's line. */
const char *chart_method_colour(MethodColour colour);

/* Write an element of gnuplot's plot command for the data block $<data><number>: a line through its points, or their
   marks. */
void chart_write_line(FILE *script, char data, int number, const ChartStyle *style);
void chart_write_marks(FILE *script, char data, int number, const ChartStyle *style);
