/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/border_axis.h"

#include <math.h>
#include <string.h>

/* Axes with a larger ratio of their ends are logarithmic. */
static const double long_axis = 8;

/* An axis with a smaller ratio of its ends would exaggerate differences of a few percent; it is widened by the factor
   `apart` at both ends. */
static const double least_ratio = 1.5, apart = 1.5;

/* mm */
static const double tic_digit = 1.65, tic_gap = 1;

enum { TICS_SIZE = 2048, MOST_STEPS = 4 };

BorderAxis border_axis(const BorderTable *table, int first, double width) {
    BorderAxis axis = {.width = width, .least = INFINITY, .most = -INFINITY};
    int falling = 0;
    for (int i = first; i < table->count; i++) {
        const BorderRow *row = &table->rows[i];
        if (strcmp(row->study, table->rows[first].study) != 0) continue;
        axis.least = fmin(axis.least, fmin(row->holds_at, row->fails_at));
        axis.most = fmax(axis.most, fmax(row->holds_at, row->fails_at));
        falling += (row->fails_at < row->holds_at) - (row->fails_at > row->holds_at);
    }
    if (!(axis.least <= axis.most)) axis.least = axis.most = 0;
    if (axis.least > 0 && axis.most / axis.least < least_ratio) {
        axis.least /= apart;
        axis.most *= apart;
    }
    axis.logarithmic = axis.least > 0 && axis.most / axis.least > long_axis;
    axis.falling = falling > 0;
    stability_axis_text(axis.label, table->rows[first].parameter, table->rows[first].unit);
    return axis;
}

double border_axis_place(const BorderAxis *axis, double value) {
    double inside = axis->width - 2 * BORDER_AXIS_ROOM;
    if (axis->least == axis->most) return axis->width / 2;
    double share = axis->logarithmic ? log(value / axis->least) / log(axis->most / axis->least)
                                     : (value - axis->least) / (axis->most - axis->least);
    return BORDER_AXIS_ROOM + inside * share;
}

/* Tics, collected from left to right. */
typedef struct Tics {
    const BorderAxis *axis;
    char text[TICS_SIZE];
    size_t used;
    double taken; /* mm: right end of the last label */
    bool crowded; /* two labels touch */
} Tics;

static void add_tic(Tics *tics, double value, int digits, const char *name) {
    double place = border_axis_place(tics->axis, value), half = digits * tic_digit / 2;
    if (place < 0 || place > tics->axis->width || tics->used + 64 > TICS_SIZE) return;
    if (place - half < tics->taken + tic_gap && tics->used > 0) tics->crowded = true;
    tics->taken = place + half;
    tics->used += (size_t)snprintf(tics->text + tics->used, TICS_SIZE - tics->used, "%s'%s' %.6g",
                                   tics->used > 0 ? ", " : "", name, place);
}

static const double plain_least = 1e-3, plain_most = 1e5;

/* Tics at these digits in every `step`-th decade. */
static void add_decades(Tics *tics, const char *digits, int step) {
    int first = (int)floor(log10(tics->axis->least)) - 1, last = (int)ceil(log10(tics->axis->most)) + 1;
    for (int decade = first; decade <= last; decade++)
        for (const char *digit = digits; decade % step == 0 && *digit != '\0'; digit++) {
            double value = (*digit - '0') * pow(10, decade);
            bool plain = tics->axis->least >= plain_least && tics->axis->most < plain_most;
            char name[32];
            int length = plain ? snprintf(name, sizeof name, "%g", value)
                               : snprintf(name, sizeof name, "%.*s10^{%s%d}", *digit == '1' ? 0 : 3,
                                          (const char[]){*digit, '\xC2', '\xB7', '\0'}, decade < 0 ? "−" : "",
                                          decade < 0 ? -decade : decade);
            add_tic(tics, value, plain ? length : 4, name);
        }
}

/* As many tics as fit. */
static void log_tics(Tics *tics) {
    static const char *const digits[] = {"125", "1", "1", "1", "1", "1"};
    const BorderAxis *axis = tics->axis;
    for (int i = 0; i < 6; i++) {
        *tics = (Tics){.axis = axis};
        add_decades(tics, digits[i], i < 2 ? 1 : 2 * (i - 1));
        if (!tics->crowded) return;
    }
}

static double round_step(double step) {
    double decade = pow(10, floor(log10(step))), digit = step / decade;
    return (digit <= 1 ? 1 : digit <= 2 ? 2 : digit <= 5 ? 5 : 10) * decade;
}

/* Multiples of the step, so that 0 is exactly 0. */
static void add_steps(Tics *tics, double step) {
    double first = ceil(tics->axis->least / step - 1);
    for (int i = 0; i < 2 * MOST_STEPS + 4; i++) {
        double value = (first + i) * step;
        char name[32];
        if (value < tics->axis->least - step / 2 || value > tics->axis->most + step / 2) continue;
        add_tic(tics, value, snprintf(name, sizeof name, "%.6g", value), name);
    }
}

static void linear_tics(Tics *tics) {
    const BorderAxis *axis = tics->axis;
    char name[32];
    if (axis->least == axis->most) {
        add_tic(tics, axis->least, snprintf(name, sizeof name, "%.4g", axis->least), name);
        return;
    }
    for (int steps = MOST_STEPS; steps > 0; steps--) {
        *tics = (Tics){.axis = axis};
        add_steps(tics, round_step((axis->most - axis->least) / steps));
        if (!tics->crowded) return;
    }
}

void border_axis_write(const BorderAxis *axis, GnuplotPage *page) {
    Tics tics = {.axis = axis};
    char text[TICS_SIZE + 32];
    (axis->logarithmic ? log_tics : linear_tics)(&tics);
    snprintf(text, sizeof text, "out offset 0,0.3 (%s)", tics.text);
    gnuplot_linear_axis(page, 'x', 0, axis->width, text, axis->label);
}
