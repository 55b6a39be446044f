/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Three panels, one per target: the paper does not state which of them its Table 1 is about. */
#include "paper/figures/plot_parts.h"
#include "paper/study/paper_tables.h"
#include "paper/study/published.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PANELS = 3, NETWORKS = 12, PUBLISHED = PAPER_OPTIMIZERS, CONSTANT, SERIES };

/* The networks that differ from the baseline only in target or optimizer: one of each pair. */
static const char *const networks[NETWORKS] = {"baseline",       "target-net",   "target-impulse", "optimizer-gd",
                                               "optimizer-bfgs", "optimizer-lm", "net-gd",         "net-bfgs",
                                               "net-lm",         "impulse-gd",   "impulse-bfgs",   "impulse-lm"};

static const PlotGrid grid = {.width = FIGURE_PAGE_WIDTH,
                              .height = 72,
                              .left = 13.5,
                              .right = 2,
                              .bottom = 17.5,
                              .top = 6,
                              .columns = PANELS,
                              .rows = 1,
                              .gap = 4.5};

/* Limits of the axis: a training that diverged would squeeze the others. */
static const double least_error = 1e-8, most_error = 10;

static bool is_shown(const ScoreRow *row) {
    for (int i = 0; i < NETWORKS; i++)
        if (strcmp(row->network, networks[i]) == 0) return row->target < PANELS;
    return false;
}

static int compare_rows(const void *first, const void *second) {
    const ScoreRow *a = first, *b = second;
    int order = strcmp(a->network, b->network);
    if (order == 0) order = a->target - b->target;
    return order != 0 ? order : (a->iteration > b->iteration) - (a->iteration < b->iteration);
}

typedef struct Loss {
    const ScoreRow *rows; /* sorted: those of one network follow each other */
    int count;
} Loss;

static void panel_of(const void *of, int panel, PlotPanel *out) {
    static const char *const titles[PANELS] = {"Pair: change by its own impulses", "Net: change by all impulses",
                                               "Impulse: change in one sweep"};
    const Loss *loss = of;
    PlotRange x = plot_range(), y = plot_range();
    for (int i = 0; i < PUBLISHED_SCORES; i++)
        plot_range_include(&x, published_scores[i].iteration), plot_range_include(&y, published_scores[i].test);
    for (int i = 0; i < loss->count; i++) {
        plot_range_include(&x, loss->rows[i].iteration);
        plot_range_include(&y, loss->rows[i].test);
        plot_range_include(&y, loss->rows[i].constant);
    }
    out->box = plot_grid_box(&grid, panel);
    out->title = titles[panel];
    out->x = plot_range_axis(x, 1, 1e6, true, "Training iteration");
    out->y = plot_range_axis(y, least_error, most_error, false, panel == 0 ? "Mean squared error" : NULL);
}

static PlotLook look_of(const void *of, int series) {
    static const char *const optimizers[] = {"Adam", "gradient descent", "BFGS", "Levenberg-Marquardt"};
    (void)of;
    if (series == CONSTANT) return plot_look_dashed("predicting the mean");
    if (series < PAPER_OPTIMIZERS) return plot_look(series, optimizers[series]);
    PlotLook look = plot_look(7, "the paper's Table 1");
    look.style.colour = look.style.ink = 0x000000;
    look.above = true;
    return look;
}

/* The constant predictor's error is that of the panel's first row that has one. */
static double constant_of(const Loss *loss, int panel) {
    for (int i = 0; i < loss->count; i++)
        if (loss->rows[i].target == panel && !isnan(loss->rows[i].constant)) return loss->rows[i].constant;
    return NAN;
}

static bool point_of(const void *of, int panel, int series, int i, PlotPoint *out) {
    const Loss *loss = of;
    const ScoreRow *row = &loss->rows[i];
    if (series == CONSTANT) {
        *out = (PlotPoint){i == 0 ? -INFINITY : INFINITY, constant_of(loss, panel), 0};
        return i < 2;
    }
    if (series == PUBLISHED) {
        if (i < PUBLISHED_SCORES) *out = (PlotPoint){published_scores[i].iteration, published_scores[i].test, 0};
        return i < PUBLISHED_SCORES;
    }
    if (i >= loss->count) return false;
    *out = (PlotPoint){row->iteration, row->test, 0};
    return row->target == panel && row->optimizer == series;
}

bool plot_loss(const char *folder, PlotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &paper_score_layout, error)) return false;
    ScoreRow *rows = table.rows;
    Loss loss = {.rows = rows};
    for (int i = 0; i < table.count; i++)
        if (is_shown(&rows[i])) rows[loss.count++] = rows[i];
    if (loss.count > 0) qsort(rows, (size_t)loss.count, sizeof *rows, compare_rows);
    const PlotSpec spec = {
        .of = &loss,
        .width = grid.width,
        .height = grid.height,
        .panels = PANELS,
        .series = SERIES,
        .rows = loss.count + PUBLISHED_SCORES,
        .panel = panel_of,
        .look = look_of,
        .point = point_of,
        .legend_columns = 3,
        .legend_left = grid.left,
        .legend_top = 6,
        .caption = "Mean squared error of the normalised outputs on test rows over training iterations (0: before "
                   "training), for each reading of the target. Dashed: the constant predictor. The paper's own errors "
                   "are in each panel, as the paper does not state which target they are for."};
    const bool drawn = loss.count == 0 || plot_draw(page, &spec, folder, error);
    csv_table_free(&table);
    return drawn;
}
