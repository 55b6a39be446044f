/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What laws in the loss cost and bring: the error on the left, what is violated on the right. */
#include "chart/figure_axis.h"
#include "chart/figure_seeds.h"
#include "paper/figures/figures.h"
#include "paper/study/paper_tables.h"

#include <math.h>
#include <stdlib.h>

static const char *const titles[LAWS] = {"Momentum (kg m/s)", "Energy (J)", "Approach (m/s)", "Friction cone (N s)"};

/* mm */
static const double height = 97, left = 13.5, error_width = 56, small_left = 84, small_width = 38.5, small_gap = 10,
                    right_bottom = 17.8, row_gap = 7.5, top = 6, legend_top = 6.2;

/* Of violations; and what is smaller than this share of the largest is nothing. */
static const double least_violation = 1e-12, most_violation = 1e12, share_shown = 1e-6;

typedef struct LawsFigure {
    FigurePage *page;
    const LawRow *rows;
    int count;
    SeedPoint *points; /* [count] room */
    FigureAxis x;
} LawsFigure;

/* What a panel shows: the violation of a law, or (LAW_SET_ALL) the error over the constant's. */
static double measure(const LawRow *row, int panel) {
    return panel == LAW_SET_ALL ? row->test / row->constant : row->violation[panel];
}

/* The points of a line: without laws, that is weight 0, and with its own. */
static int gather(const LawsFigure *laws, int line, int panel, const FigureAxis *y) {
    int count = 0;
    for (int i = 0; i < laws->count; i++) {
        const LawRow *row = &laws->rows[i];
        double value = measure(row, panel), weight = row->laws == LAW_SET_NONE ? 0 : row->weight;
        if ((row->laws != line && row->laws != LAW_SET_NONE) || isnan(value) || isnan(weight)) continue;
        laws->points[count++] = (SeedPoint){isnan(row->seed) ? 0 : row->seed, figure_on(laws->page, &laws->x, weight),
                                            figure_on(laws->page, y, value)};
    }
    return count;
}

static bool is_used(const LawsFigure *laws, int line) {
    for (int i = 0; i < laws->count; i++)
        if (laws->rows[i].laws == line) return true;
    return false;
}

static FigureLook look_of(int line) {
    static const char *const names[] = {"momentum", "energy", "approach", "friction cone", "all four laws"};
    return figure_look(line == LAW_SET_ALL ? 0 : line + 1, names[line]);
}

/* Lines that a panel shows: in the error's all, else the law's own and all. */
static void put_lines(const LawsFigure *laws, int panel, const FigureAxis *y) {
    for (int thick = 0; thick <= 1; thick++)
        for (int line = 0; line <= LAW_SET_ALL; line++) {
            if ((panel != LAW_SET_ALL && line != panel && line != LAW_SET_ALL) || !is_used(laws, line)) continue;
            FigureLook look = look_of(line);
            int count = gather(laws, line, panel, y);
            (thick ? figure_seed_median : figure_seed_lines)(laws->page, laws->points, count, &look);
        }
}

/* Dashed: the labels' own violation; in the error's panel the constant, 1. */
static void put_dashed(const LawsFigure *laws, int panel, const FigureAxis *y) {
    FigureLook look = figure_dashed("");
    double value = panel == LAW_SET_ALL ? 1 : NAN;
    for (int i = 0; i < laws->count; i++)
        if (panel != LAW_SET_ALL && laws->rows[i].laws == LAW_SET_ENGINE) value = laws->rows[i].violation[panel];
    figure_series(laws->page);
    value = figure_on(laws->page, y, value);
    figure_segment(laws->page, laws->x.log.low, value, laws->x.log.high, value);
    figure_draw(laws->page, &look);
}

static FigureAxis error_axis(FigureRange range) {
    figure_widen(&range, 1);
    return figure_axis(range, 1e-4, 1e3, false);
}

static FigureAxis axis_of(const LawsFigure *laws, int panel) {
    FigureRange range = figure_range();
    bool zero = false;
    for (int i = 0; i < laws->count; i++) {
        if (panel != LAW_SET_ALL && laws->rows[i].laws != panel && laws->rows[i].laws < LAW_SET_ALL) continue;
        figure_widen(&range, measure(&laws->rows[i], panel));
        zero |= measure(&laws->rows[i], panel) == 0;
    }
    if (panel == LAW_SET_ALL) return error_axis(range);
    if (!(range.most > 0)) range = (FigureRange){0.1, 1};
    double lowest = fmax(least_violation, fmin(range.most, most_violation) * share_shown);
    FigureAxis axis = figure_axis(range, lowest, most_violation, zero);
    axis.log.powers = true;
    return axis;
}

static void put_panel(const LawsFigure *laws, int panel) {
    FigurePage *page = laws->page;
    FigureAxis y = axis_of(laws, panel);
    double small = (height - right_bottom - row_gap - top) / 2;
    FigureBox box = {left, right_bottom, error_width, height - right_bottom - top};
    if (panel != LAW_SET_ALL)
        box = (FigureBox){small_left + (panel % 2) * (small_width + small_gap),
                          right_bottom + (panel < 2) * (small + row_gap), small_width, small};
    figure_panel(page, box, panel == LAW_SET_ALL ? "Error" : titles[panel]);
    figure_log(page, 'x', &laws->x, panel == LAW_SET_ALL || panel >= 2 ? "Weight in the loss" : NULL);
    figure_log(page, 'y', &y,
               panel == LAW_SET_ALL ? "Test error / that of predicting the mean"
               : panel % 2 == 0     ? "Mean violation"
                                    : "");
    put_dashed(laws, panel, &y);
    put_lines(laws, panel, &y);
    figure_panel_end(page);
}

static void put_legend(const LawsFigure *laws) {
    FigureLook looks[LAW_SET_ALL + 2];
    int count = 0;
    for (int line = 0; line <= LAW_SET_ALL; line++)
        if (is_used(laws, line)) looks[count++] = look_of(line);
    looks[count++] = figure_dashed("predicting the mean / the engine");
    figure_legend(laws->page, looks, count, 3, left, legend_top);
}

static void draw(LawsFigure *laws) {
    FigureRange weights = figure_range();
    for (int i = 0; i < laws->count; i++)
        if (laws->rows[i].laws <= LAW_SET_ALL) figure_widen(&weights, laws->rows[i].weight);
    laws->x = figure_axis(weights, 1e-9, 1e9, true);
    figure_begin(laws->page, FIGURE_PAGE_WIDTH, height);
    put_panel(laws, LAW_SET_ALL);
    for (int law = 0; law < LAWS; law++) put_panel(laws, law);
    put_legend(laws);
    fprintf(laws->page->caption,
            "Laws of physics in the loss, over their weight (0: without). Left: test error over that of always "
            "predicting the mean. Right: mean violation of each law on the test rows, with that law alone and with all "
            "four; dashed: of the engine's own solution. Thin: one seed each; thick: their median.");
    figure_end(laws->page);
}

bool figure_laws(const char *folder, FigurePage *page, Error *error) {
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
