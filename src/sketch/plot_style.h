/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Styles of lines and marks, all distinguishable in grey. */
#pragma once
#include "common/method_description.h"
#include "sketch/sketch.h"

#define PLOT_GREY 0x606060u
#define PARETO_COLOUR 0xC8C8C8u

/* Continues MethodSymbol. */
enum { PLOT_PLUS = METHOD_SYMBOLS, PLOT_CROSS, PLOT_STAR, PLOT_UPRIGHT, PLOT_LEVEL, PLOT_SYMBOLS };

typedef struct PlotStyle {
    int symbol; /* a MethodSymbol, or one of the crosses and bars above */
    bool open;
    uint32_t colour;    /* of lines and marks */
    uint32_t ink;       /* darker, of text */
    const char *dashes; /* as of a Pen */
} PlotStyle;

/* The style of series i, which is no method. */
PlotStyle plot_style(int i);

/* The styles of `count` series, each of a method (NULL: unknown), all different: colour and symbol of its description.
   Several series of one method have one colour, the second with an open symbol, further ones with others. */
void plot_method_styles(const MethodDescription *const *methods, int count, PlotStyle *styles);

/* The colour of a method's line. */
uint32_t plot_method_colour(MethodColour colour);

/* A mark of this radius in mm; the lines of open symbols and crosses are `line` wide (LINE_UNIT). */
void plot_mark(Sketch *sketch, Point at, const PlotStyle *style, double radius, double line);

/* The marks of a series. White ones below, slightly larger, separate them from the lines and marks of others. */
#define MARK_RADIUS 0.72 /* mm */
void plot_marks(Sketch *sketch, const Point *points, int count, const PlotStyle *style);
