/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/map_axis.h"

#include "type/type.h"

#include <math.h>
#include <stdio.h>

/* mm */
static const double number_height = 3, number_points = 7.5, least_between_ticks = 1.2;

/* Three significant digits; integers up to 1e6 in full. */
static void name_value(char text[32], double value) {
    bool whole = fabs(value) > 999 && fabs(value) < 1e6;
    snprintf(text, 32, whole ? "%.0f" : "%.3g", value);
}

double map_axis_width(const double *values, int count) {
    char text[32];
    double widest = 0;
    for (int i = 0; i < count; i++) {
        name_value(text, values[i]);
        widest = fmax(widest, type_width(text, number_points));
    }
    return widest;
}

/* Digits that are not zero at the end: 1 of 40, 2 of 41 and of 0.25. */
static int digits_of(double value) {
    char text[32];
    snprintf(text, sizeof text, "%.2e", fabs(value));
    return text[3] != '0' ? 3 : text[2] != '0' ? 2 : 1;
}

/* Which values have a label: every so many, from one on. */
typedef struct Labels {
    int first, every;
} Labels;

static double roughness(const double *values, int count, Labels labels) {
    double digits = 0, labelled = 0;
    for (int i = labels.first; i < count; i += labels.every, labelled++) digits += digits_of(values[i]);
    return digits / labelled;
}

/* All if there is room; else steps of 2, 5 or 10 values and so on, beginning where the labelled values are roundest. */
static Labels choose_labels(const double *values, int count, int least) {
    static const int steps[] = {1, 2, 5, 10, 20, 50, 100};
    Labels best = {0, least};
    for (size_t i = sizeof steps / sizeof *steps; i > 0; i--)
        if (steps[i - 1] >= least) best.every = steps[i - 1];
    if (least < 3) best.every = least;
    if (best.every >= count) return (Labels){0, count};
    const int every = best.every;
    for (int first = 1; first < every && first < count; first++)
        if (roughness(values, count, (Labels){first, every}) < roughness(values, count, best)) best.first = first;
    return best;
}

PlotAxis map_axis(PlotTicks *ticks, bool across, const double *values, int count, double room) {
    const double needed = across ? map_axis_width(values, count) + 1.7 : number_height;
    const Labels labels = choose_labels(values, count, (int)ceil(needed / room));
    PlotAxis axis = plot_linear_axis(-0.5, count - 0.5, NULL);
    ticks->count = 0;
    for (int i = 0; i < count; i++) {
        char text[32] = "";
        const bool labelled = i >= labels.first && (i - labels.first) % labels.every == 0;
        if (!labelled && room < least_between_ticks) continue;
        if (labelled) name_value(text, values[i]);
        plot_tick_add(ticks, i, false, text);
    }
    axis.ticks = ticks;
    axis.outside = true;
    return axis;
}
