/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/border_axis.h"

#include <math.h>
#include <string.h>

/* Axes with a larger ratio of their ends are logarithmic. */
static const double long_axis = 8;

/* An axis with a smaller ratio of its ends would exaggerate differences of a few percent; it is widened by the factor
   `apart` at both ends. */
static const double least_ratio = 1.5, apart = 1.5;

/* Beyond this range numbers are powers of ten. */
static const double plain_least = 1e-3, plain_most = 1e5;

/* An axis for [least, most], with the margins. */
static PlotAxis with_margins(double least, double most, double width) {
    const double share = BORDER_AXIS_ROOM / (width - 2 * BORDER_AXIS_ROOM);
    PlotAxis axis = plot_linear_axis(least - share * (most - least), most + share * (most - least), NULL);
    if (least > 0 && most / least > long_axis) {
        axis.scale = PLOT_LOG;
        axis.low = least / pow(most / least, share);
        axis.high = most * pow(most / least, share);
        axis.powers = least < plain_least || most >= plain_most;
    }
    axis.outside = true;
    return axis;
}

BorderAxis border_axis(const BorderTable *table, int first, double width) {
    BorderAxis axis = {0};
    double least = INFINITY, most = -INFINITY;
    int falling = 0;
    for (int i = first; i < table->count; i++) {
        const BorderRow *row = &table->rows[i];
        if (strcmp(row->study, table->rows[first].study) != 0) continue;
        least = fmin(least, fmin(row->holds_at, row->fails_at));
        most = fmax(most, fmax(row->holds_at, row->fails_at));
        falling += (row->fails_at < row->holds_at) - (row->fails_at > row->holds_at);
    }
    if (!(least <= most)) least = most = 0;
    if (least > 0 && most / least < least_ratio) {
        least /= apart;
        most *= apart;
    }
    axis.axis = with_margins(least, most, width);
    axis.falling = falling > 0;
    stability_axis_text(axis.label, table->rows[first].parameter, table->rows[first].unit);
    return axis;
}
