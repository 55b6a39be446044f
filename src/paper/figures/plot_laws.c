/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Laws in the loss: the test error on the left, the violation of each law on the right. */
#include "chart/gnuplot_axis.h"
#include "chart/gnuplot_seeds.h"
#include "paper/figures/plot_parts.h"
#include "paper/study/paper_tables.h"

#include <math.h>
#include <stdlib.h>

static const char *const titles[LAWS] = {"Momentum (kg m/s)", "Energy (J)", "Approach (m/s)", "Friction cone (N s)"};

/* mm */
static const double height = 97, left = 13.5, error_width = 56, small_left = 84, small_width = 38.5, small_gap = 10,
                    right_bottom = 17.8, row_gap = 7.5, top = 6, legend_top = 6.2;

/* Limits of violations; and the lowest one shown, as a share of the highest. */
static const double least_violation = 1e-12, most_violation = 1e12, share_shown = 1e-6;

typedef struct LawsFigure {
    GnuplotPage *page;
    const LawRow *rows;
    int count;
    SeedPoint *points; /* [count] room */
    GnuplotAxis x;
} LawsFigure;

/* The value in a panel: the violation of its law, or (LAW_SET_ALL) the error over the constant predictor's. */
static double measure(const LawRow *row, int panel) {
    return panel == LAW_SET_ALL ? row->test / row->constant : row->violation[panel];
}

/* The points of a line: networks without laws, at weight 0, and those with the line's law. */
static int gather(const LawsFigure *laws, int line, int panel, const GnuplotAxis *y) {
    int count = 0;
    for (int i = 0; i < laws->count; i++) {
        const LawRow *row = &laws->rows[i];
        double value = measure(row, panel), weight = row->laws == LAW_SET_NONE ? 0 : row->weight;
        if ((row->laws != line && row->laws != LAW_SET_NONE) || isnan(value) || isnan(weight)) continue;
        laws->points[count++] =
            (SeedPoint){isnan(row->seed) ? 0 : row->seed, gnuplot_axis_clamp(laws->page, &laws->x, weight),
                        gnuplot_axis_clamp(laws->page, y, value)};
    }
    return count;
}

static bool is_used(const LawsFigure *laws, int line) {
    for (int i = 0; i < laws->count; i++)
        if (laws->rows[i].laws == line) return true;
    return false;
}

static GnuplotLook look_of(int line) {
    static const char *const names[] = {"momentum", "energy", "approach", "friction cone", "all four laws"};
    return gnuplot_look(line == LAW_SET_ALL ? 0 : line + 1, names[line]);
}

/* The panel of the error has a line for each law and for all; that of a law has its own line and the one for all. */
static void draw_lines(const LawsFigure *laws, int panel, const GnuplotAxis *y) {
    for (int thick = 0; thick <= 1; thick++)
        for (int line = 0; line <= LAW_SET_ALL; line++) {
            if ((panel != LAW_SET_ALL && line != panel && line != LAW_SET_ALL) || !is_used(laws, line)) continue;
            GnuplotLook look = look_of(line);
            int count = gather(laws, line, panel, y);
            (thick ? gnuplot_seed_median : gnuplot_seed_lines)(laws->page, laws->points, count, &look);
        }
}

/* The labels' own violation; in the error's panel the constant predictor, 1. */
static void draw_dashed(const LawsFigure *laws, int panel, const GnuplotAxis *y) {
    GnuplotLook look = gnuplot_look_dashed("");
    double value = panel == LAW_SET_ALL ? 1 : NAN;
    for (int i = 0; i < laws->count; i++)
        if (panel != LAW_SET_ALL && laws->rows[i].laws == LAW_SET_ENGINE) value = laws->rows[i].violation[panel];
    gnuplot_series_begin(laws->page);
    value = gnuplot_axis_clamp(laws->page, y, value);
    gnuplot_segment(laws->page, laws->x.log.low, value, laws->x.log.high, value);
    gnuplot_series_end(laws->page, &look);
}

static GnuplotAxis error_axis(GnuplotRange range) {
    gnuplot_range_include(&range, 1);
    return gnuplot_axis(range, 1e-4, 1e3, false);
}

static GnuplotAxis axis_of(const LawsFigure *laws, int panel) {
    GnuplotRange range = gnuplot_range();
    bool zero = false;
    for (int i = 0; i < laws->count; i++) {
        if (panel != LAW_SET_ALL && laws->rows[i].laws != panel && laws->rows[i].laws < LAW_SET_ALL) continue;
        gnuplot_range_include(&range, measure(&laws->rows[i], panel));
        zero |= measure(&laws->rows[i], panel) == 0;
    }
    if (panel == LAW_SET_ALL) return error_axis(range);
    if (!(range.most > 0)) range = (GnuplotRange){0.1, 1};
    double lowest = fmax(least_violation, fmin(range.most, most_violation) * share_shown);
    GnuplotAxis axis = gnuplot_axis(range, lowest, most_violation, zero);
    axis.log.powers = true;
    return axis;
}

static void draw_panel(const LawsFigure *laws, int panel) {
    GnuplotPage *page = laws->page;
    GnuplotAxis y = axis_of(laws, panel);
    double small = (height - right_bottom - row_gap - top) / 2;
    GnuplotBox box = {left, right_bottom, error_width, height - right_bottom - top};
    if (panel != LAW_SET_ALL)
        box = (GnuplotBox){small_left + (panel % 2) * (small_width + small_gap),
                           right_bottom + (panel < 2) * (small + row_gap), small_width, small};
    gnuplot_panel_begin(page, box, panel == LAW_SET_ALL ? "Error" : titles[panel]);
    gnuplot_log_axis(page, 'x', &laws->x, panel >= 2 ? "Weight in the loss" : NULL);
    gnuplot_log_axis(page, 'y', &y,
                     panel == LAW_SET_ALL ? "Test error / that of predicting the mean"
                     : panel % 2 == 0     ? "Mean violation"
                                          : "");
    draw_dashed(laws, panel, &y);
    draw_lines(laws, panel, &y);
    gnuplot_panel_end(page);
}

static void draw_legend(const LawsFigure *laws) {
    GnuplotLook looks[LAW_SET_ALL + 2];
    int count = 0;
    for (int line = 0; line <= LAW_SET_ALL; line++)
        if (is_used(laws, line)) looks[count++] = look_of(line);
    looks[count++] = gnuplot_look_dashed("predicting the mean / the engine");
    gnuplot_legend(laws->page, looks, count, 3, left, legend_top);
}

static void draw(LawsFigure *laws) {
    GnuplotRange weights = gnuplot_range();
    for (int i = 0; i < laws->count; i++)
        if (laws->rows[i].laws <= LAW_SET_ALL) gnuplot_range_include(&weights, laws->rows[i].weight);
    laws->x = gnuplot_axis(weights, 1e-9, 1e9, true);
    gnuplot_page_begin(laws->page, FIGURE_PAGE_WIDTH, height);
    draw_panel(laws, LAW_SET_ALL);
    for (int law = 0; law < LAWS; law++) draw_panel(laws, law);
    draw_legend(laws);
    fprintf(
        laws->page->caption,
        "Laws of physics in the loss, over their weight (0: without). Left: test error over that of the constant "
        "predictor. Right: mean violation of each law on the test rows, with only that law and with all four; dashed: "
        "the engine's own solution. Thin: one seed each; thick: their median.");
    gnuplot_page_end(laws->page);
}

bool plot_laws(const char *folder, GnuplotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &paper_law_layout, error)) return false;
    LawsFigure laws = {.page = page, .rows = table.rows, .count = table.count};
    laws.points = malloc((size_t)table.count * sizeof *laws.points);
    bool room = laws.points != NULL, used = false;
    for (int line = 0; line <= LAW_SET_ALL; line++) used |= is_used(&laws, line);
    if (room && used) draw(&laws);
    free(laws.points);
    csv_table_free(&table);
    return room || error_memory(error, folder);
}
