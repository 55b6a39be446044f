/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The axes of plots: from values to places on the page, and ticks at round numbers. */
#pragma once
#include <stdbool.h>

/* The range of the values above 0. */
typedef struct PlotRange {
    double least, most;
} PlotRange;

PlotRange plot_range(void);
void plot_range_include(PlotRange *range, double value); /* ignores NaN, infinite values and those not above 0 */

typedef struct PlotTick {
    double value;
    bool minor;       /* short, without a number */
    char text[48];    /* may have two lines */
    int digit, power; /* digit > 0: the number is digit · 10^power instead of the text */
} PlotTick;

enum { PLOT_TICKS = 512 };

typedef struct PlotTicks {
    int count;
    PlotTick items[PLOT_TICKS];
} PlotTicks;

typedef enum PlotScale {
    PLOT_LINEAR,
    PLOT_LOG,
    PLOT_DOUBLING /* logarithmic, with ticks at powers of two */
} PlotScale;

typedef struct PlotAxis {
    PlotScale scale;
    double low, high;       /* values at the ends; high may be less; equal: all values are in the middle */
    double from, to;        /* mm: places of the ends on the page */
    double least;           /* no ticks below */
    double zero;            /* of a logarithmic axis: the value at whose place 0 is; 0: none */
    bool powers;            /* numbers are powers of ten */
    bool outside;           /* ticks are outside the frame */
    const PlotTicks *ticks; /* NULL: chosen */
    const char *label;      /* NULL: neither label nor numbers; "": numbers only */
} PlotAxis;

PlotAxis plot_linear_axis(double low, double high, const char *label);

/* For values in [least, most], both above 0, with padding on both sides and at least one decade, so that it has ticks. */
PlotAxis plot_log_axis(double least, double most, const char *label);

/* The same for a range clamped to [lowest, highest]. with_zero: adds a place for 0, left of the ticks. */
PlotAxis plot_range_axis(PlotRange range, double lowest, double highest, bool with_zero, const char *label);

/* mm on the page. */
double plot_axis_place(const PlotAxis *axis, double value);

/* A value that is on the axis. *beyond becomes true if it is another one; infinite values stand for the ends. */
double plot_axis_clamp(const PlotAxis *axis, double value, bool *beyond);

void plot_tick_add(PlotTicks *ticks, double value, bool minor, const char *text);

/* mm: of a tick's number. */
double plot_tick_width(const PlotTick *tick, double points);

/* As many ticks at round numbers as have room for numbers of this size. across: along the page's width. */
void plot_ticks_choose(PlotTicks *ticks, const PlotAxis *axis, double points, bool across);
