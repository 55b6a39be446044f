/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Three panels, one per target: the paper does not state which of them its Table 1 is about. */
#include "chart/gnuplot_axis.h"
#include "paper/figures/plot_parts.h"
#include "paper/study/paper_tables.h"
#include "paper/study/published.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PANELS = 3, NETWORKS = 12, LINES = PAPER_OPTIMIZERS + 2 };

/* The networks that differ from the baseline only in target or optimizer. */
static const char *const networks[NETWORKS] = {"baseline",       "target-net",   "target-impulse", "optimizer-gd",
                                               "optimizer-bfgs", "optimizer-lm", "net-gd",         "net-bfgs",
                                               "net-lm",         "impulse-gd",   "impulse-bfgs",   "impulse-lm"};
static const char *const optimizer_names[] = {"Adam", "gradient descent", "BFGS", "Levenberg-Marquardt"};
static const char *const titles[PANELS] = {"Pair: change by its own impulses", "Net: change by all impulses",
                                           "Impulse: change in one sweep"};

/* mm */
static const double height = 72, left = 13.5, right = 2, gap = 4.5, bottom = 17.5, top = 6, legend_top = 6;

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
    GnuplotPage *page;
    const ScoreRow *rows;
    int count;
    GnuplotAxis x, y;
    bool used[PAPER_OPTIMIZERS];
} Loss;

static void choose_axes(Loss *loss) {
    GnuplotRange x = gnuplot_range(), y = gnuplot_range();
    for (int i = 0; i < PUBLISHED_SCORES; i++)
        gnuplot_range_include(&x, published_scores[i].iteration), gnuplot_range_include(&y, published_scores[i].test);
    for (int i = 0; i < loss->count; i++) {
        gnuplot_range_include(&x, loss->rows[i].iteration);
        gnuplot_range_include(&y, loss->rows[i].test);
        gnuplot_range_include(&y, loss->rows[i].constant);
        loss->used[loss->rows[i].optimizer] = true;
    }
    loss->x = gnuplot_axis(x, 1, 1e6, true);
    loss->y = gnuplot_axis(y, least_error, most_error, false);
}

static void draw_point(Loss *loss, double iteration, double error) {
    gnuplot_point(loss->page, gnuplot_axis_clamp(loss->page, &loss->x, iteration),
                  gnuplot_axis_clamp(loss->page, &loss->y, error));
}

static void draw_constant(Loss *loss, int target) {
    GnuplotLook look = gnuplot_look_dashed("");
    gnuplot_series_begin(loss->page);
    for (int i = 0; i < loss->count; i++) {
        const ScoreRow *row = &loss->rows[i];
        if (row->target != target || isnan(row->constant)) continue;
        double y = gnuplot_axis_clamp(loss->page, &loss->y, row->constant);
        gnuplot_segment(loss->page, loss->x.log.low, y, loss->x.log.high, y);
        break;
    }
    gnuplot_series_end(loss->page, &look);
}

static GnuplotLook paper_look(void) {
    GnuplotLook look = gnuplot_look(7, "the paper's Table 1");
    look.style.colour = look.style.ink = "black";
    return look;
}

static void draw_paper(Loss *loss) {
    GnuplotLook look = paper_look();
    gnuplot_series_begin(loss->page);
    for (int i = 0; i < PUBLISHED_SCORES; i++)
        draw_point(loss, published_scores[i].iteration, published_scores[i].test);
    gnuplot_series_end(loss->page, &look);
}

/* Rows are sorted: those of one network and target follow each other. */
static void draw_networks(Loss *loss, int target) {
    for (int i = 0, end; i < loss->count; i = end) {
        const ScoreRow *row = &loss->rows[i];
        for (end = i; end < loss->count && strcmp(loss->rows[end].network, row->network) == 0; end++)
            if (loss->rows[end].target != row->target) break;
        if (row->target != target) continue;
        GnuplotLook look = gnuplot_look(row->optimizer, "");
        gnuplot_series_begin(loss->page);
        for (int k = i; k < end; k++) draw_point(loss, loss->rows[k].iteration, loss->rows[k].test);
        gnuplot_series_end(loss->page, &look);
    }
}

static void draw_panel(Loss *loss, int target) {
    GnuplotPage *page = loss->page;
    double width = (FIGURE_PAGE_WIDTH - left - right - gap * (PANELS - 1)) / PANELS;
    gnuplot_panel_begin(page, (GnuplotBox){left + target * (width + gap), bottom, width, height - top - bottom},
                        titles[target]);
    gnuplot_log_axis(page, 'x', &loss->x, "Training iteration");
    gnuplot_log_axis(page, 'y', &loss->y, target == 0 ? "Mean squared error" : NULL);
    draw_constant(loss, target);
    draw_networks(loss, target);
    draw_paper(loss);
    gnuplot_panel_end(page);
}

static void draw_legend(Loss *loss) {
    GnuplotLook looks[LINES];
    int count = 0;
    for (int i = 0; i < PAPER_OPTIMIZERS; i++)
        if (loss->used[i]) looks[count++] = gnuplot_look(i, optimizer_names[i]);
    looks[count++] = paper_look();
    looks[count++] = gnuplot_look_dashed("predicting the mean");
    gnuplot_legend(loss->page, looks, count, 3, left, legend_top);
}

bool plot_loss(const char *folder, GnuplotPage *page, Error *error) {
    Loss loss = {.page = page};
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &paper_score_layout, error)) return false;
    ScoreRow *rows = table.rows;
    for (int i = 0; i < table.count; i++)
        if (is_shown(&rows[i])) rows[loss.count++] = rows[i];
    if (loss.count > 0) {
        qsort(rows, (size_t)loss.count, sizeof *rows, compare_rows);
        loss.rows = rows;
        choose_axes(&loss);
        gnuplot_page_begin(page, FIGURE_PAGE_WIDTH, height);
        for (int target = 0; target < PANELS; target++) draw_panel(&loss, target);
        draw_legend(&loss);
        fprintf(
            page->caption,
            "Mean squared error of the normalised outputs on test rows over training iterations (0: before "
            "training), for each reading of the target. Dashed: the constant predictor. The paper's own errors are in "
            "each panel, as the paper does not state which target they are for.");
        gnuplot_page_end(page);
    }
    csv_table_free(&table);
    return true;
}
