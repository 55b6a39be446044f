/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What plots are made of: axes and their ticks, styles, marks. */
#include "base/numbers.h"
#include "figures/plot.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "pixels/png.h"
#include "pixels/type.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Of a logarithmic axis, at both ends, so that marks and labels do not touch the frame. */
static const double padding = 0.07;

/* Distance of 0 left of the least value: decades, or a share of the axis if that is more. */
static const double to_zero = 0.5, share_to_zero = 0.18;

/* Outside this range numbers are powers of ten. */
static const double plain_least = 1e-3, plain_most = 1e4;

/* Decades; on a longer axis, ticks at 2 and 5 are too dense. mm: a shorter decade has no minor ticks. */
static const double long_axis = 2.3, least_decade = 4;

PlotRange plot_range(void) { return (PlotRange){INFINITY, 0}; }

void plot_range_include(PlotRange *range, double value) {
    if (!(value > 0) || isinf(value)) return;
    range->least = fmin(range->least, value);
    range->most = fmax(range->most, value);
}

PlotAxis plot_linear_axis(double low, double high, const char *label) {
    return (PlotAxis){.scale = PLOT_LINEAR, .low = low, .high = high, .to = 1, .least = -INFINITY, .label = label};
}

PlotAxis plot_log_axis(double least, double most, const char *label) {
    double low = log10(least), high = log10(most), room = fmax((high - low) * padding, (1 - (high - low)) / 2);
    PlotAxis axis = {
        .scale = PLOT_LOG, .low = pow(10, low - room), .high = pow(10, high + room), .to = 1, .label = label};
    axis.least = axis.low;
    return axis;
}

PlotAxis plot_range_axis(PlotRange range, double lowest, double highest, bool with_zero, const char *label) {
    double most = fmin(fmax(range.most, lowest), highest), least = fmin(fmax(range.least, lowest), most);
    double decades = fmax(to_zero, share_to_zero * log10(most / least)), zero = least / pow(10, decades);
    PlotAxis axis = plot_log_axis(with_zero ? zero : least, most, label);
    axis.powers = axis.low < plain_least || axis.high > plain_most;
    if (with_zero) axis.zero = zero, axis.least = least * 0.999;
    return axis;
}

double plot_axis_place(const PlotAxis *axis, double value) {
    if (axis->low == axis->high) return (axis->from + axis->to) / 2;
    const double share = axis->scale == PLOT_LINEAR ? (value - axis->low) / (axis->high - axis->low)
                                                    : log(value / axis->low) / log(axis->high / axis->low);
    return axis->from + (axis->to - axis->from) * share;
}

double plot_axis_clamp(const PlotAxis *axis, double value, bool *beyond) {
    if (isnan(value)) return value;
    if (isinf(value)) return value < 0 ? axis->low : axis->high;
    if (axis->scale == PLOT_LINEAR) return value;
    if (axis->zero > 0 && value <= 0) return axis->zero;
    const double on = fmin(fmax(value, axis->least), axis->high);
    if (on != value) *beyond = true;
    return on;
}

void plot_tick_add(PlotTicks *ticks, double value, bool minor, const char *text) {
    if (ticks->count == PLOT_TICKS) return;
    PlotTick *tick = &ticks->items[ticks->count++];
    *tick = (PlotTick){.value = value, .minor = minor};
    snprintf(tick->text, sizeof tick->text, "%s", text);
}

double plot_tick_width(const PlotTick *tick, double points) {
    return tick->digit > 0 ? sketch_power_width(points, tick->digit, tick->power) : type_width(tick->text, points);
}

/* mm: between the middles of two numbers one above the other, and between two side by side. */
static bool is_crowded(const PlotTicks *ticks, const PlotAxis *axis, double points, bool across) {
    const double em = points * MM_PER_POINT, between = across ? 0.4 * em : 1.35 * em;
    const PlotTick *before = NULL;
    for (int i = 0; i < ticks->count; i++) {
        const PlotTick *tick = &ticks->items[i];
        if (tick->text[0] == '\0' && tick->digit == 0) continue;
        const double sizes =
            across && before != NULL ? (plot_tick_width(before, points) + plot_tick_width(tick, points)) / 2 : 0;
        if (before != NULL &&
            fabs(plot_axis_place(axis, tick->value) - plot_axis_place(axis, before->value)) < sizes + between)
            return true;
        before = tick;
    }
    return false;
}

static bool is_on(const PlotAxis *axis, double value) {
    const double low = fmin(axis->low, axis->high), high = fmax(axis->low, axis->high);
    const double slack = axis->scale == PLOT_LINEAR ? 1e-9 * (high - low) : 0;
    return value >= fmax(low, axis->least) - slack && value <= high + slack;
}

/* Multiples of the step, so that 0 is exactly 0. */
static void add_steps(PlotTicks *ticks, const PlotAxis *axis, double step) {
    const double low = fmin(axis->low, axis->high);
    const int decimals = step >= 0.99 ? 0 : (int)ceil(-log10(step) - 1e-9);
    const bool plain = fmax(fabs(axis->low), fabs(axis->high)) < 1e6 && decimals < 7;
    for (int i = 0; i < 24; i++) {
        const double value = (ceil(low / step - 1e-9) + i) * step;
        char text[48];
        if (!is_on(axis, value)) break;
        if (plain)
            snprintf(text, sizeof text, "%s", show_decimals(value, decimals).text);
        else
            snprintf(text, sizeof text, "%.6g", value);
        plot_tick_add(ticks, value, false, text);
    }
}

/* Numbers at these digits in every `step`-th decade. */
static void add_decades(PlotTicks *ticks, const PlotAxis *axis, const char *digits, int step) {
    const double decade_length = fabs(axis->to - axis->from) / fabs(log10(axis->high / axis->low));
    const int first = (int)floor(log10(axis->low)), last = (int)ceil(log10(axis->high));
    for (int decade = first; decade <= last; decade++)
        for (int digit = 1; digit <= 9; digit++) {
            const double value = digit * pow(10, decade);
            const bool numbered = decade % step == 0 && strchr(digits, '0' + digit) != NULL;
            char text[48] = "";
            if (!is_on(axis, value) || (!numbered && digit > 1 && decade_length < least_decade)) continue;
            if (numbered && !axis->powers) snprintf(text, sizeof text, "%g", value);
            plot_tick_add(ticks, value, !numbered, text);
            if (numbered && axis->powers && ticks->count > 0) {
                ticks->items[ticks->count - 1].digit = digit;
                ticks->items[ticks->count - 1].power = decade;
            }
        }
}

/* The densest ticks whose numbers have room. */
void plot_ticks_choose(PlotTicks *ticks, const PlotAxis *axis, double points, bool across) {
    const double most_steps = 8, length = fabs(axis->high - axis->low);
    const bool short_axis = axis->scale == PLOT_LOG && log10(axis->high / axis->low) < long_axis;
    const int last = axis->scale == PLOT_LINEAR ? 10 : 12;
    double width = round_up(length / most_steps); /* of a step of a linear axis */
    char text[48];
    ticks->count = 0;
    if (axis->scale == PLOT_LINEAR && length == 0) {
        snprintf(text, sizeof text, "%.4g", axis->low);
        plot_tick_add(ticks, axis->low, false, text);
        return;
    }
    for (int step = short_axis ? 0 : 1; step <= last; step++) {
        ticks->count = 0;
        switch (axis->scale) {
        case PLOT_LINEAR:
            add_steps(ticks, axis, width);
            width = round_up(1.5 * width);
            break;
        case PLOT_LOG:
            if (axis->zero > 0) plot_tick_add(ticks, axis->zero, false, "0");
            add_decades(ticks, axis, step == 0 ? "125" : "1", step == 0 ? 1 : step);
            break;
        case PLOT_DOUBLING:
            for (int power = 0; power <= 30; power += step) {
                snprintf(text, sizeof text, "%d", 1 << power);
                if (is_on(axis, 1 << power)) plot_tick_add(ticks, 1 << power, false, text);
            }
            break;
        }
        if (!is_crowded(ticks, axis, points, across)) return;
    }
}

/* For series that are no methods: filled, then open; then crosses. */
enum { SHAPES = 6, STYLES = 2 * SHAPES + 3 };
static const int shapes[SHAPES] = {
    METHOD_CIRCLE, METHOD_SQUARE, METHOD_TRIANGLE, METHOD_DIAMOND, METHOD_INVERTED_TRIANGLE, METHOD_PENTAGON};

static const char *const dashes[] = {NULL, "(5,2.5)", "(1.6,1.6)", "(6,1.8,1.4,1.8)", "(9,2.5)", "(3.2,1.8,3.2,4)"};

enum { DASHES = sizeof dashes / sizeof *dashes };

PlotStyle plot_style(int i) {
    const int place = i % STYLES;
    const RunColours hue = colours_hue(i % (COLOUR_HUES - 1)); /* without wine: it is dark, as black is */
    return (PlotStyle){place < 2 * SHAPES ? shapes[place % SHAPES] : PLOT_PLUS + place - 2 * SHAPES,
                       place >= SHAPES && place < 2 * SHAPES, hue.light.fill, hue.ink, dashes[i % (DASHES - 1)]};
}

PlotStyle plot_method_style(const RunColours *colours) {
    const int symbol = ((int)colours->symbol + colours->shade / 2) % METHOD_SYMBOLS;
    return (PlotStyle){symbol, colours->shade % 2 == 1, colours->light.fill, colours->ink, dashes[symbol]};
}

/* Corners, the angle of the first one and the radius, such that all look equally large. */
static const struct {
    int corners;
    double first, radius;
} polygons[METHOD_SYMBOLS] = {
    [METHOD_CIRCLE] = {24, 0, 1},     [METHOD_SQUARE] = {4, 45, 1.25},   [METHOD_TRIANGLE] = {3, 90, 1.35},
    [METHOD_DIAMOND] = {4, 90, 1.27}, [METHOD_PENTAGON] = {5, 90, 1.15}, [METHOD_INVERTED_TRIANGLE] = {3, -90, 1.35}};

static void draw_polygon(Sketch *sketch, Point at, int symbol, double radius, const Pen *pen) {
    Point corners[24];
    const int count = polygons[symbol].corners;
    for (int i = 0; i < count; i++) {
        const double angle = polygons[symbol].first * M_PI / 180 + 2 * M_PI * i / count;
        const double reach = radius * polygons[symbol].radius;
        corners[i] = (Point){at.x + reach * cos(angle), at.y + reach * sin(angle)};
    }
    sketch_shape(sketch, corners, count, pen);
}

void plot_mark(Sketch *sketch, Point at, const PlotStyle *style, double radius, double line) {
    const Pen stroke = pen_line(style->colour, line, NULL), open = {NO_COLOUR, 1, style->colour, line, NULL},
              fill = {style->colour, 1, NO_COLOUR, 0, NULL};
    if (style->symbol >= PLOT_UPRIGHT) {
        const double across = 0.4 * radius; /* an upright bar is seen behind a dot */
        const double x = style->symbol == PLOT_LEVEL ? 1.4 * radius : across;
        const double y = style->symbol == PLOT_LEVEL ? across : 2 * radius;
        sketch_rectangle(sketch, (Point){at.x - x, at.y - y}, (Point){at.x + x, at.y + y}, &fill);
    } else if (style->symbol >= METHOD_SYMBOLS) {
        for (int i = 0; i < 4; i++) {
            if ((style->symbol == PLOT_PLUS && i % 2 == 1) || (style->symbol == PLOT_CROSS && i % 2 == 0)) continue;
            const double x = radius * cos(M_PI / 4 * i), y = radius * sin(M_PI / 4 * i);
            sketch_line(sketch, (Point){at.x - x, at.y - y}, (Point){at.x + x, at.y + y}, &stroke);
        }
    } else if (style->open) {
        draw_polygon(sketch, at, style->symbol, radius - line * LINE_UNIT / 2, &open);
    } else {
        draw_polygon(sketch, at, style->symbol, radius, &fill);
    }
}

void plot_marks(Sketch *sketch, const Point *points, int count, const PlotStyle *style) {
    const double halo = 0.22; /* mm */
    for (int i = 0; i < count && style->symbol < METHOD_SYMBOLS; i++)
        draw_polygon(sketch, points[i], style->symbol, MARK_RADIUS + halo, &(Pen){0xFFFFFF, 1, NO_COLOUR, 0, NULL});
    for (int i = 0; i < count; i++) plot_mark(sketch, points[i], style, MARK_RADIUS, 1.6);
}
