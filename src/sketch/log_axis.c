/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sketch/log_axis.h"

#include <math.h>
#include <stdlib.h>

/* Of its length, at both ends, so that marks and labels do not touch the frame. */
static const double padding = 0.07;

/* Decades; on a longer axis, tics at 2 and 5 are too dense. */
static const double long_axis = 2.3;

LogAxis log_axis(double least, double most) {
    double low = log10(least), high = log10(most), room = fmax((high - low) * padding, (1 - (high - low)) / 2);
    return (LogAxis){pow(10, low - room), pow(10, high + room), 0, 1, false};
}

double log_axis_place(const LogAxis *axis, double value) {
    return axis->from + (axis->to - axis->from) * log(value / axis->low) / log(axis->high / axis->low);
}

/* More labels would overlap at the height of a small panel. */
static const int max_labels = 8;

static void format_tic(char *text, size_t size, const LogAxis *axis, int digit, int decade, double value) {
    if (!axis->powers)
        snprintf(text, size, "%g", value);
    else if (digit == 1)
        snprintf(text, size, "10^{%s%d}", decade < 0 ? "−" : "", abs(decade));
    else
        snprintf(text, size, "%d·10^{%s%d}", digit, decade < 0 ? "−" : "", abs(decade));
}

void log_axis_write_tics(const LogAxis *axis, char letter, bool labelled, FILE *script) {
    bool short_axis = log10(axis->high / axis->low) < long_axis;
    int first = (int)floor(log10(axis->low)), last = (int)ceil(log10(axis->high));
    int step = (last - first) / (max_labels + 1) + 1;
    const char *separator = "";
    fprintf(script, "set %ctics scale 0.6,0.35 (", letter);
    for (int decade = first; decade <= last; decade++)
        for (int digit = 1; digit <= 9; digit++) {
            double value = digit * pow(10, decade);
            if (value < axis->low || value > axis->high) continue;
            bool major = (digit == 1 && decade % step == 0) || (short_axis && (digit == 2 || digit == 5));
            char text[32] = "";
            if (major && labelled) format_tic(text, sizeof text, axis, digit, decade, value);
            fprintf(script, "%s'%s' %.10g %d", separator, text, value, !major);
            separator = ", ";
        }
    fprintf(script, ")\n");
}
