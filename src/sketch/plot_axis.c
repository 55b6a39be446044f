/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sketch/plot_axis.h"

#include "sketch/sketch.h"
#include "type/type.h"

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

static void choose_steps(PlotTicks *ticks, const PlotAxis *axis, double points, bool across) {
    static const double digits[] = {1, 2, 5};
    const double most_steps = 8, length = fabs(axis->high - axis->low);
    char text[48];
    if (length == 0) {
        snprintf(text, sizeof text, "%.4g", axis->low);
        plot_tick_add(ticks, axis->low, false, text);
        return;
    }
    for (int decade = (int)floor(log10(length / most_steps)), i = 0; i < 12; i++) {
        const double step = digits[i % 3] * pow(10, decade + i / 3);
        if (step < length / most_steps) continue;
        ticks->count = 0;
        add_steps(ticks, axis, step);
        if (!is_crowded(ticks, axis, points, across)) return;
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

static void choose_decades(PlotTicks *ticks, const PlotAxis *axis, double points, bool across) {
    const bool short_axis = log10(axis->high / axis->low) < long_axis;
    for (int step = short_axis ? 0 : 1; step <= 12; step++) {
        ticks->count = 0;
        if (axis->zero > 0) plot_tick_add(ticks, axis->zero, false, "0");
        add_decades(ticks, axis, step == 0 ? "125" : "1", step == 0 ? 1 : step);
        if (!is_crowded(ticks, axis, points, across)) return;
    }
}

static void choose_doublings(PlotTicks *ticks, const PlotAxis *axis, double points, bool across) {
    for (int step = 1; step <= 12; step++) {
        ticks->count = 0;
        for (int power = 0; power <= 30; power += step) {
            char text[48];
            snprintf(text, sizeof text, "%d", 1 << power);
            if (is_on(axis, 1 << power)) plot_tick_add(ticks, 1 << power, false, text);
        }
        if (!is_crowded(ticks, axis, points, across)) return;
    }
}

void plot_ticks_choose(PlotTicks *ticks, const PlotAxis *axis, double points, bool across) {
    ticks->count = 0;
    switch (axis->scale) {
    case PLOT_LINEAR: choose_steps(ticks, axis, points, across); break;
    case PLOT_LOG: choose_decades(ticks, axis, points, across); break;
    case PLOT_DOUBLING: choose_doublings(ticks, axis, points, across); break;
    }
}
