/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plots of the study: rates of right predictions, losses, laws; and the drawing of all plots. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "figures/plot.h"
#include "figures/sketch.h"
#include "learning/pair_training.h"
#include "paper/paper_report.h"
#include "paper/paper_tables.h"
#include "paper/report_internal.h"
#include "scenes/scenes.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Three definitions of a right prediction side by side; impacts above, rest below. */

enum {
    DEFINITIONS = RATE_DEFINITIONS,
    RATED = 4, /* networks */
    SWEEPS = 3,
    ENGINES = RATED,
    RATES_CONSTANT = ENGINES + SWEEPS,
    BAND,
    RATES_SERIES
};

enum { PHASES_SHOWN = 2 };
static const int phases[PHASES_SHOWN] = {PHASE_IMPACT, PHASE_REST};
static const char *const rated[RATED] = {"baseline", "target-net", "target-impulse", "contact-net"};

/* The paper's prediction rates, %. */
static const double paper_least = 60, paper_most = 91;

static int find_network(const char *name) {
    int i = 0;
    while (i < RATED && strcmp(rated[i], name) != 0) i++;
    return i;
}

/* Networks are side by side within their scene; each has its own constant predictor and engine. */
static bool rates_point(const void *of, int panel, int series, int i, PlotPoint *out) {
    const RateRow *row = (const RateRow *)of + i;
    if (series == BAND) return plot_level(out, i, i == 0 ? paper_least : paper_most);
    if (row->definition != panel % DEFINITIONS || row->phase != phases[panel / DEFINITIONS]) return false;
    const int network = find_network(row->network);
    const int share = series < RATED             ? RATE_NETWORK
                      : series == RATES_CONSTANT ? RATE_CONSTANT
                                                 : RATE_ENGINE1 + series - ENGINES;
    *out = (PlotPoint){row->scene + 0.2 * (network - (RATED - 1) / 2.0), 100 * row->share[share], 0};
    return series >= RATED || network == series;
}

static bool plot_rates(const CsvTable *table, PlotPage *page, Error *error) {
    static const char *const titles[DEFINITIONS] = {"Within 5% of the output's range", "Within 0.1 m/s",
                                                    "Bodies right, by the reference"};
    static const char *const labels[PHASES_SHOWN] = {"Right at impacts (%)", "Right at rest (%)"};
    static const char *const scenes[PAPER_SCENES] = {"single", "stack", "pyramid", "pyramid,\nsettled"};
    static const char *const engines[SWEEPS] = {"engine, 1 sweep", "engine, 4 sweeps", "engine, 10 sweeps"};
    const PlotGrid grid = {FIGURE_PAGE_WIDTH, 105.5,        13.5,     2,           20.5, 6,
                           DEFINITIONS,       PHASES_SHOWN, .gap = 4, .row_gap = 5};
    RateRow *rows = table->rows;
    int count = 0;
    for (int i = 0; i < table->count; i++)
        if (find_network(rows[i].network) < RATED && (rows[i].phase == PHASE_IMPACT || rows[i].phase == PHASE_REST))
            rows[count++] = rows[i];
    if (count == 0) return true;

    PlotTicks scene_ticks = {0}, share_ticks = {0};
    for (int scene = 0; scene < PAPER_SCENES; scene++) plot_tick_add(&scene_ticks, scene, false, scenes[scene]);
    for (int share = 0; share <= 100; share += 20) {
        char text[12];
        snprintf(text, sizeof text, "%d", share);
        plot_tick_add(&share_ticks, share, false, text);
    }
    PlotPanel panels[PHASES_SHOWN * DEFINITIONS];
    for (int i = 0; i < PHASES_SHOWN * DEFINITIONS; i++) {
        const int phase = i / DEFINITIONS;
        panels[i] = (PlotPanel){.box = plot_grid_box(&grid, i),
                                .title = phase == 0 ? titles[i] : NULL,
                                .x = plot_linear_axis(-0.5, PAPER_SCENES - 0.5, phase == 0 ? NULL : ""),
                                .y = plot_linear_axis(-3, 104, i % DEFINITIONS == 0 ? labels[phase] : NULL)};
        panels[i].x.ticks = &scene_ticks;
        panels[i].y.ticks = &share_ticks;
    }
    PlotLook looks[RATES_SERIES];
    for (int i = 0; i < RATED; i++) {
        looks[i] = plot_look(i, rated[i]);
        looks[i].stems = true;
        looks[i].line = 2.5;
    }
    for (int i = ENGINES; i <= RATES_CONSTANT; i++) {
        const bool constant = i == RATES_CONSTANT;
        looks[i] = (PlotLook){.name = constant ? "predicting the mean" : engines[i - ENGINES],
                              .style = {.symbol = constant ? PLOT_LEVEL : PLOT_PLUS + i - ENGINES,
                                        .colour = constant ? 0x000000 : PLOT_GREY},
                              .marks = true,
                              .above = true};
    }
    looks[BAND] = (PlotLook){.name = "the paper's 60 to 91%", .style = {.colour = 0xE4E4E4}, .band = true};
    const PlotSpec spec = {
        .width = grid.width,
        .height = grid.height,
        .panels = panels,
        .looks = looks,
        .panel_count = PHASES_SHOWN * DEFINITIONS,
        .series = RATES_SERIES,
        .rows = count,
        .point = rates_point,
        .of = rows,
        .legend_columns = RATED,
        .legend_left = 13.5,
        .legend_top = 6 + LEGEND_ROW,
        .caption = "Share of right predictions in each scene by three definitions, at impacts and at rest. Beside each "
                   "network, a mark for each split of its launches: the constant predictor (bar) and the engine with "
                   "1, 4 and 10 sweeps (crosses). Grey band: "
                   "the paper's 60 to 91%."};
    return plot_draw(page, &spec, table->csv.path, error);
}

/* Three panels, one per target: the paper does not state which of them its Table 1 is about. */

enum { LOSS_PANELS = 3, LOSS_NETWORKS = 12, PUBLISHED = PAPER_OPTIMIZERS, LOSS_CONSTANT, LOSS_SERIES };

/* The networks that differ from the baseline only in target or optimizer: one of each pair. */
static const char *const loss_networks[LOSS_NETWORKS] = {
    "baseline", "target-net", "target-impulse", "optimizer-gd", "optimizer-bfgs", "optimizer-lm",
    "net-gd",   "net-bfgs",   "net-lm",         "impulse-gd",   "impulse-bfgs",   "impulse-lm"};

/* At the paper's iterations, as trainings on other splits end at others. */
static bool is_shown(const ScoreRow *row) {
    bool published = false;
    for (int i = 0; i < PUBLISHED_SCORES; i++) published |= row->iteration == published_scores[i].iteration;
    for (int i = 0; published && i < LOSS_NETWORKS; i++)
        if (strcmp(row->network, loss_networks[i]) == 0) return row->target < LOSS_PANELS;
    return false;
}

static int compare_rows(const void *first, const void *second) {
    const ScoreRow *a = first, *b = second;
    int order = strcmp(a->network, b->network);
    if (order == 0) order = (a->seed > b->seed) - (a->seed < b->seed);
    return order != 0 ? order : (a->iteration > b->iteration) - (a->iteration < b->iteration);
}

typedef struct Loss {
    const ScoreRow *rows; /* [count] sorted: those of one training follow each other */
    int count;
    double constant[LOSS_PANELS];
} Loss;

static bool loss_point(const void *of, int panel, int series, int i, PlotPoint *out) {
    const Loss *loss = of;
    const ScoreRow *row = &loss->rows[i];
    if (series == LOSS_CONSTANT) return plot_level(out, i, loss->constant[panel]);
    if (series == PUBLISHED) {
        if (i < PUBLISHED_SCORES) *out = (PlotPoint){published_scores[i].iteration, published_scores[i].test, 0};
        return i < PUBLISHED_SCORES;
    }
    if (i >= loss->count) return false;
    *out = (PlotPoint){row->iteration, row->test, row->seed};
    return row->target == panel && row->optimizer == series;
}

static bool plot_loss(const CsvTable *table, PlotPage *page, Error *error) {
    static const char *const titles[LOSS_PANELS] = {"Pair: change by its own impulses", "Net: change by all impulses",
                                                    "Impulse: change in one sweep"};
    static const char *const optimizers[] = {"Adam", "gradient descent", "BFGS", "Levenberg-Marquardt"};
    /* Limits of the axis: a training that diverged would squeeze the others. */
    const double least_error = 1e-8, most_error = 10;
    const PlotGrid grid = {FIGURE_PAGE_WIDTH, 72, 13.5, 2, 17.5, 6, LOSS_PANELS, 1, .gap = 4.5};
    ScoreRow *rows = table->rows;
    Loss loss = {.rows = rows, .constant = {NAN, NAN, NAN}};
    for (int i = 0; i < table->count; i++)
        if (is_shown(&rows[i])) rows[loss.count++] = rows[i];
    if (loss.count == 0) return true;
    qsort(rows, (size_t)loss.count, sizeof *rows, compare_rows);

    PlotRange x = plot_range(), y = plot_range();
    for (int i = 0; i < PUBLISHED_SCORES; i++)
        plot_range_include(&x, published_scores[i].iteration), plot_range_include(&y, published_scores[i].test);
    for (int i = 0; i < loss.count; i++) {
        plot_range_include(&x, rows[i].iteration);
        plot_range_include(&y, rows[i].test);
        plot_range_include(&y, rows[i].constant);
        /* That of a panel's first row that has one. */
        if (isnan(loss.constant[rows[i].target])) loss.constant[rows[i].target] = rows[i].constant;
    }
    PlotPanel panels[LOSS_PANELS];
    for (int i = 0; i < LOSS_PANELS; i++)
        panels[i] =
            (PlotPanel){.box = plot_grid_box(&grid, i),
                        .title = titles[i],
                        .x = plot_range_axis(x, 1, 1e6, true, "Training iteration"),
                        .y = plot_range_axis(y, least_error, most_error, false, i == 0 ? "Mean squared error" : NULL)};
    PlotLook looks[LOSS_SERIES] = {
        [PUBLISHED] = plot_look(7, "the paper's Table 1"), [LOSS_CONSTANT] = plot_look_dashed("predicting the mean")};
    for (int i = 0; i < PAPER_OPTIMIZERS; i++) {
        looks[i] = plot_look(i, optimizers[i]);
        looks[i].seeds = true;
    }
    looks[PUBLISHED].style.colour = looks[PUBLISHED].style.ink = 0x000000;
    looks[PUBLISHED].above = true;
    const PlotSpec spec = {
        .width = grid.width,
        .height = grid.height,
        .panels = panels,
        .looks = looks,
        .panel_count = LOSS_PANELS,
        .series = LOSS_SERIES,
        .rows = loss.count + PUBLISHED_SCORES,
        .point = loss_point,
        .of = &loss,
        .legend_columns = 3,
        .legend_left = 13.5,
        .legend_top = 6,
        .caption =
            "Mean squared error on test rows, each output in its range over the training rows, over training "
            "iterations (0: before training), for each reading of the target. Thin: one split each; thick: their "
            "median. Dashed: the constant predictor on the first split. The paper's own errors "
            "are in each panel, as the paper does not state which target they are for."};
    return plot_draw(page, &spec, table->csv.path, error);
}

/* Laws in the loss: the test error on the left, the violation of each law on the right. */

/* Panels: the error, then each law. Series: each law alone and all laws; the reference. */
enum { ERROR_PANEL, LAW_PANELS = 1 + LAWS, REFERENCE = LAW_SET_ALL + 1, LAW_SERIES };

/* The value in a panel: the violation of its law, or the error over the constant predictor's. */
static double law_value(const LawRow *row, int panel) {
    return panel == ERROR_PANEL ? row->test / row->constant : row->violation[panel - 1];
}

typedef struct Laws {
    const LawRow *rows;
    int count;
    bool used[LAW_WORDS]; /* by some row */
} Laws;

/* Each line begins with the networks without laws, at weight 0. The reference is the labels' own violation; in the
   error's panel the constant predictor, 1. */
static bool laws_point(const void *of, int panel, int series, int i, PlotPoint *out) {
    const Laws *laws = of;
    const LawRow *row = &laws->rows[i];
    if (series == REFERENCE) {
        double value = panel == ERROR_PANEL ? 1 : NAN;
        for (int k = 0; k < laws->count; k++)
            if (panel != ERROR_PANEL && laws->rows[k].laws == LAW_SET_ENGINE) value = law_value(&laws->rows[k], panel);
        return plot_level(out, i, value);
    }
    /* The panel of the error has a line for each law and for all; that of a law has its own line and the one for all.
       */
    if (panel != ERROR_PANEL && series != panel - 1 && series != LAW_SET_ALL) return false;
    const bool none = row->laws == LAW_SET_NONE;
    *out = (PlotPoint){none ? 0 : row->weight, law_value(row, panel), isnan(row->seed) ? 0 : row->seed};
    return laws->used[series] && (none || row->laws == series);
}

static PlotAxis law_axis(const Laws *laws, int panel) {
    /* Limits of violations; and the lowest one shown, as a share of the highest. */
    const double least_violation = 1e-12, most_violation = 1e12, share_shown = 1e-6;
    PlotRange range = plot_range();
    bool zero = false;
    for (int i = 0; i < laws->count; i++) {
        const LawRow *row = &laws->rows[i];
        if (panel != ERROR_PANEL && row->laws != panel - 1 && row->laws < LAW_SET_ALL) continue;
        plot_range_include(&range, law_value(row, panel));
        zero |= law_value(row, panel) == 0;
    }
    if (panel == ERROR_PANEL) {
        plot_range_include(&range, 1);
        return plot_range_axis(range, 1e-4, 1e3, false, "Test error / that of predicting the mean");
    }
    if (!(range.most > 0)) range = (PlotRange){0.1, 1};
    const double lowest = fmax(least_violation, fmin(range.most, most_violation) * share_shown);
    PlotAxis axis = plot_range_axis(range, lowest, most_violation, zero, panel % 2 == 1 ? "Mean violation" : "");
    axis.powers = true;
    return axis;
}

static bool plot_laws(const CsvTable *table, PlotPage *page, Error *error) {
    static const char *const titles[LAW_PANELS] = {"Error", "Momentum (kg m/s)", "Energy (J)", "Approach (m/s)",
                                                   "Friction cone (N s)"};
    static const char *const names[] = {"momentum", "energy", "approach", "friction cone", "all four laws"};
    /* The panels of the laws; the one of the error is as high as all of them. */
    const PlotGrid grid = {FIGURE_PAGE_WIDTH, 97, 84, 3, 17.8, 6, 2, LAWS / 2, .gap = 10, .row_gap = 7.5};
    const double error_left = 13.5, error_width = 56; /* mm */
    Laws laws = {.rows = table->rows, .count = table->count};
    PlotRange weights = plot_range();
    bool used = false;
    for (int i = 0; i < laws.count; i++) {
        const LawRow *row = &laws.rows[i];
        laws.used[row->laws] = true;
        used |= row->laws <= LAW_SET_ALL;
        if (row->laws <= LAW_SET_ALL) plot_range_include(&weights, row->weight);
    }
    if (!used) return true;

    PlotPanel panels[LAW_PANELS];
    for (int i = 0; i < LAW_PANELS; i++)
        panels[i] =
            (PlotPanel){.box = i == ERROR_PANEL ? (PlotBox){error_left, grid.bottom, error_width,
                                                            grid.height - grid.bottom - grid.top}
                                                : plot_grid_box(&grid, i - 1),
                        .title = titles[i],
                        .x = plot_range_axis(weights, 1e-9, 1e9, true, i == 1 || i == 2 ? NULL : "Weight in the loss"),
                        .y = law_axis(&laws, i)};
    PlotLook looks[LAW_SERIES] = {[REFERENCE] = plot_look_dashed("predicting the mean / the engine")};
    for (int i = 0; i <= LAW_SET_ALL; i++) {
        looks[i] = plot_look(i == LAW_SET_ALL ? 0 : i + 1, names[i]);
        looks[i].seeds = true;
        looks[i].above = i == LAW_SET_ALL;
    }
    const PlotSpec spec = {
        .width = grid.width,
        .height = grid.height,
        .panels = panels,
        .looks = looks,
        .panel_count = LAW_PANELS,
        .series = LAW_SERIES,
        .rows = laws.count,
        .point = laws_point,
        .of = &laws,
        .legend_columns = 3,
        .legend_left = error_left,
        .legend_top = 6.2,
        .caption =
            "Laws of physics in the loss, over their weight (0: without). Left: test error over that of the "
            "constant predictor. Right: mean violation of each law on the test rows, with only that law and with "
            "all four; dashed: the engine's own solution. Thin: one seed each; thick: their median."};
    return plot_draw(page, &spec, table->csv.path, error);
}

static const struct {
    const char *name;
    const CsvLayout *layout;
    PlotWrite *write;
} plots[] = {
    {"loss", &paper_score_layout, plot_loss},  {"factors", &paper_trained_layout, plot_factors},
    {"rates", &paper_rate_layout, plot_rates}, {"closed-loop", &paper_closed_loop_layout, plot_closed_loop},
    {"laws", &paper_law_layout, plot_laws},    {"transfer", &paper_transfer_layout, plot_transfer},
};

enum { PLOTS = sizeof plots / sizeof *plots };

/* All tables are read before the first picture is written. */
bool plots_draw(const char *folder, const Progress *progress, Error *error) {
    char path[PATH_MAX];
    PlotPage pages[PLOTS];
    memset(pages, 0, sizeof pages);
    bool done = file_path(path, sizeof path, error, "%s/figures", folder);
    for (int i = 0; done && i < PLOTS; i++) {
        CsvTable table;
        done = csv_table_read_from(&table, folder, plots[i].layout, error);
        if (!done) break;
        done = plots[i].write(&table, &pages[i], error);
        csv_table_free(&table);
    }
    done = done && file_make_directory(path, error);
    for (int i = 0; done && i < PLOTS; i++)
        done = (progress_report(progress, i, PLOTS) ||
                error_interrupted(error, path, "stopped; the tables are finished")) &&
               plot_page_write(&pages[i], path, "", plots[i].name, error);
    for (int i = 0; i < PLOTS; i++) plot_page_free(&pages[i]);
    return done;
}
