/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/gnuplot_axis.h"

#include <math.h>

/* Distance of 0 left of the least value: decades, or a share of the axis if that is more. */
static const double to_zero = 0.5, share_to_zero = 0.18;

/* Outside this range, tics are labelled as powers of ten. */
static const double plain_least = 1e-3, plain_most = 1e4;

GnuplotRange gnuplot_range(void) { return (GnuplotRange){INFINITY, 0}; }

void gnuplot_range_include(GnuplotRange *range, double value) {
    if (!(value > 0)) return;
    range->least = fmin(range->least, value);
    range->most = fmax(range->most, value);
}

GnuplotAxis gnuplot_axis(GnuplotRange range, double lowest, double highest, bool with_zero) {
    double most = fmin(fmax(range.most, lowest), highest), least = fmin(fmax(range.least, lowest), most);
    double decades = fmax(to_zero, share_to_zero * log10(most / least));
    GnuplotAxis axis = {.zero = with_zero ? least / pow(10, decades) : 0};
    axis.log = log_axis(with_zero ? axis.zero : least, most);
    axis.log.powers = axis.log.low < plain_least || axis.log.high > plain_most;
    axis.least = with_zero ? least * 0.999 : axis.log.low;
    return axis;
}

void gnuplot_log_axis(GnuplotPage *page, char letter, const GnuplotAxis *axis, const char *label) {
    LogAxis tics = axis->log;
    tics.low = axis->least;
    fprintf(page->script, "set logscale %c\nset %crange [%.8g:%.8g]\n", letter, letter, axis->log.low, axis->log.high);
    log_axis_write_tics(&tics, letter, label != NULL, page->script);
    if (axis->zero > 0 && label != NULL) fprintf(page->script, "set %ctics add ('0' %.8g)\n", letter, axis->zero);
    if (label != NULL) gnuplot_axis_label(page, letter, label);
}

double gnuplot_axis_clamp(GnuplotPage *page, const GnuplotAxis *axis, double value) {
    if (isnan(value)) return value;
    if (axis->zero > 0 && value <= 0) return axis->zero;
    double on = fmin(fmax(value, axis->least), axis->log.high);
    if (on != value) page->beyond = true;
    return on;
}
