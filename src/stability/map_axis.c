/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/map_axis.h"

#include "stability/stability_map.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* mm */
static const double tic_height = 3, tic_digit = 1.65, least_between_tics = 1.2;

enum { TICS_SIZE = MAP_MAX_VALUES * 40 };

/* Three significant digits; integers up to 1e6 in full. */
static int name_value(char *text, size_t size, double value) {
    bool whole = fabs(value) > 999 && fabs(value) < 1e6;
    return snprintf(text, size, whole ? "%.0f" : "%.3g", value);
}

double map_axis_width(const double *values, int count) {
    char text[32];
    int longest = 0;
    for (int i = 0; i < count; i++) {
        int length = name_value(text, sizeof text, values[i]);
        longest = length > longest ? length : longest;
    }
    return longest * tic_digit;
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

void map_axis_write(GnuplotPage *page, char axis, const double *values, int count, double room, const char *label) {
    char tics[TICS_SIZE], text[32];
    const double needed = axis == 'x' ? map_axis_width(values, count) + tic_digit : tic_height;
    const Labels labels = choose_labels(values, count, (int)ceil(needed / room));
    const char *comma = "";
    size_t used = (size_t)snprintf(tics, sizeof tics, "out%s (", axis == 'x' ? " offset 0,0.3" : "");
    for (int i = 0; i < count; i++) {
        const bool labelled = i >= labels.first && (i - labels.first) % labels.every == 0;
        if (!labelled && room < least_between_tics) continue;
        name_value(text, sizeof text, values[i]);
        used += (size_t)snprintf(tics + used, sizeof tics - used, "%s'%s' %d", comma,
                                 label != NULL && labelled ? text : "", i);
        comma = ", ";
    }
    snprintf(tics + used, sizeof tics - used, ")");
    gnuplot_linear_axis(page, axis, -0.5, count - 0.5, tics, label);
}
