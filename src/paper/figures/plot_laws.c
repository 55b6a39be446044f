/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws in the loss: the test error on the left, the violation of each law on the right. */
#include "paper/figures/plot_parts.h"
#include "paper/study/paper_tables.h"

#include <math.h>

/* Panels: the error, then each law. Series: all laws and each law alone; the reference. */
enum { ERROR_PANEL, PANELS = 1 + LAWS, REFERENCE = LAW_SET_ALL + 1, SERIES };

/* mm */
static const double height = 97, left = 13.5, error_width = 56, bottom = 17.8, top = 6;
static const PlotGrid small = {.width = FIGURE_PAGE_WIDTH,
                               .height = 97,
                               .left = 84,
                               .right = 3,
                               .bottom = 17.8,
                               .top = 6,
                               .columns = 2,
                               .rows = LAWS / 2,
                               .gap = 10,
                               .row_gap = 7.5};

/* Limits of violations; and the lowest one shown, as a share of the highest. */
static const double least_violation = 1e-12, most_violation = 1e12, share_shown = 1e-6;

/* The value in a panel: the violation of its law, or the error over the constant predictor's. */
static double measure(const LawRow *row, int panel) {
    return panel == ERROR_PANEL ? row->test / row->constant : row->violation[panel - 1];
}

/* The panel of the error has a line for each law and for all; that of a law has its own line and the one for all. */
static bool is_in(int line, int panel) { return panel == ERROR_PANEL || line == panel - 1 || line == LAW_SET_ALL; }

static bool is_used(const CsvTable *table, int line) {
    const LawRow *rows = table->rows;
    for (int i = 0; i < table->count; i++)
        if (rows[i].laws == line) return true;
    return false;
}

static PlotAxis error_axis(PlotRange range) {
    plot_range_include(&range, 1);
    return plot_range_axis(range, 1e-4, 1e3, false, "Test error / that of predicting the mean");
}

static PlotAxis axis_of(const CsvTable *table, int panel) {
    const LawRow *rows = table->rows;
    PlotRange range = plot_range();
    bool zero = false;
    for (int i = 0; i < table->count; i++) {
        if (panel != ERROR_PANEL && rows[i].laws != panel - 1 && rows[i].laws < LAW_SET_ALL) continue;
        plot_range_include(&range, measure(&rows[i], panel));
        zero |= measure(&rows[i], panel) == 0;
    }
    if (panel == ERROR_PANEL) return error_axis(range);
    if (!(range.most > 0)) range = (PlotRange){0.1, 1};
    const double lowest = fmax(least_violation, fmin(range.most, most_violation) * share_shown);
    PlotAxis axis = plot_range_axis(range, lowest, most_violation, zero, panel % 2 == 1 ? "Mean violation" : "");
    axis.powers = true;
    return axis;
}

static void panel_of(const void *of, int panel, PlotPanel *out) {
    static const char *const titles[PANELS] = {"Error", "Momentum (kg m/s)", "Energy (J)", "Approach (m/s)",
                                               "Friction cone (N s)"};
    const CsvTable *table = of;
    const LawRow *rows = table->rows;
    PlotRange weights = plot_range();
    for (int i = 0; i < table->count; i++)
        if (rows[i].laws <= LAW_SET_ALL) plot_range_include(&weights, rows[i].weight);
    out->box = panel == ERROR_PANEL ? (PlotBox){left, bottom, error_width, height - bottom - top}
                                    : plot_grid_box(&small, panel - 1);
    out->title = titles[panel];
    out->x = plot_range_axis(weights, 1e-9, 1e9, true, panel == 1 || panel == 2 ? NULL : "Weight in the loss");
    out->y = axis_of(table, panel);
}

static PlotLook look_of(const void *of, int series) {
    static const char *const names[] = {"momentum", "energy", "approach", "friction cone", "all four laws"};
    (void)of;
    if (series == REFERENCE) return plot_look_dashed("predicting the mean / the engine");
    PlotLook look = plot_look(series == LAW_SET_ALL ? 0 : series + 1, names[series]);
    look.seeds = true;
    look.above = series == LAW_SET_ALL;
    return look;
}

/* The labels' own violation; in the error's panel the constant predictor, 1. */
static double reference_of(const CsvTable *table, int panel) {
    const LawRow *rows = table->rows;
    double value = panel == ERROR_PANEL ? 1 : NAN;
    for (int i = 0; i < table->count; i++)
        if (panel != ERROR_PANEL && rows[i].laws == LAW_SET_ENGINE) value = measure(&rows[i], panel);
    return value;
}

/* Each line begins with the networks without laws, at weight 0. */
static bool point_of(const void *of, int panel, int series, int i, PlotPoint *out) {
    const CsvTable *table = of;
    const LawRow *row = (const LawRow *)table->rows + i;
    if (series == REFERENCE) {
        *out = (PlotPoint){i == 0 ? -INFINITY : INFINITY, reference_of(table, panel), 0};
        return i < 2;
    }
    const bool none = row->laws == LAW_SET_NONE;
    *out = (PlotPoint){none ? 0 : row->weight, measure(row, panel), isnan(row->seed) ? 0 : row->seed};
    return is_in(series, panel) && is_used(table, series) && (none || row->laws == series);
}

bool plot_laws(const char *folder, PlotPage *page, Error *error) {
    CsvTable table;
    bool used = false;
    if (!csv_table_read_from(&table, folder, &paper_law_layout, error)) return false;
    const PlotSpec spec = {
        .of = &table,
        .width = small.width,
        .height = height,
        .panels = PANELS,
        .series = SERIES,
        .rows = table.count,
        .panel = panel_of,
        .look = look_of,
        .point = point_of,
        .legend_columns = 3,
        .legend_left = left,
        .legend_top = 6.2,
        .caption =
            "Laws of physics in the loss, over their weight (0: without). Left: test error over that of the "
            "constant predictor. Right: mean violation of each law on the test rows, with only that law and with "
            "all four; dashed: the engine's own solution. Thin: one seed each; thick: their median."};
    for (int line = 0; line <= LAW_SET_ALL; line++) used |= is_used(&table, line);
    const bool drawn = !used || plot_draw(page, &spec, folder, error);
    csv_table_free(&table);
    return drawn;
}
