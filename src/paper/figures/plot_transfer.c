/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One column wide: the error from scratch beside that after training on smaller scenes. */
#include "paper/figures/plot_parts.h"
#include "paper/study/paper_tables.h"

#include <math.h>

enum { STARTS = 2, CONSTANT = STARTS, SERIES };

/* mm */
static const double height = 64, left = 13, right = 2, bottom = 17.8, top = 3;

static const double least_error = 1e-6;

static PlotLook look_of(const void *of, int series) {
    static const char *const names[STARTS] = {"from scratch", "after single and stack"};
    (void)of;
    PlotLook look = series == CONSTANT ? plot_look_dashed("predicting the mean") : plot_look(series, names[series]);
    look.medians = true;
    look.seeds = series < STARTS;
    return look;
}

static bool point_of(const void *of, int panel, int series, int i, PlotPoint *out) {
    const TransferRow *row = (const TransferRow *)((const CsvTable *)of)->rows + i;
    (void)panel;
    *out = (PlotPoint){row->launches, series == CONSTANT ? row->constant : row->error, row->seed};
    return series == CONSTANT || row->transfer == series;
}

static void panel_of(const void *of, int panel, PlotPanel *out) {
    const CsvTable *table = of;
    const TransferRow *rows = table->rows;
    double least = PAPER_MAX_LAUNCHES, most = 1, error = least_error;
    (void)panel;
    for (int i = 0; i < table->count; i++) {
        least = fmin(least, rows[i].launches);
        most = fmax(most, rows[i].launches);
        error = fmax(error, fmax(rows[i].error, rows[i].constant)); /* of a number and NAN, the number */
    }
    const double margin = most > 4 * least ? 1.3 : 2;
    out->box = (PlotBox){left, bottom, FIGURE_COLUMN_WIDTH - left - right, height - bottom - top};
    out->x = plot_linear_axis(least / margin, most * margin, "Launches of the pyramid");
    out->x.scale = PLOT_DOUBLING;
    out->y = plot_linear_axis(0, error * 1.08, "RMS velocity error (m/s)");
}

bool plot_transfer(const char *folder, PlotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &paper_transfer_layout, error)) return false;
    const PlotSpec spec = {
        .of = &table,
        .width = FIGURE_COLUMN_WIDTH,
        .height = height,
        .panels = 1,
        .series = SERIES,
        .rows = table.count,
        .panel = panel_of,
        .look = look_of,
        .point = point_of,
        .legend_columns = 2,
        .legend_left = 3,
        .legend_top = 6.2,
        .caption =
            "Error on held-out launches of the pyramid, over the number of launches that a network was trained "
            "on: from scratch, and after the single box and the stack. Thin: one seed each; thick: their median. "
            "Dashed: the constant predictor."};
    const bool drawn = plot_draw(page, &spec, folder, error);
    csv_table_free(&table);
    return drawn;
}
