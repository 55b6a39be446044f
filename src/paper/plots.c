/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plots of the study: rates of right predictions, losses, laws; and the drawing of all plots. */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "figures/sketch.h"
#include "learning/pair_training.h"
#include "paper/paper_tables.h"
#include "paper/paper_report.h"
#include "paper/report_internal.h"
#include "scenes/scenes.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

const char *const paper_scene_titles[PAPER_SCENES] = {"single", "stack", "pyramid", "pyramid, settled"};

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

typedef struct Rates {
    const RateRow *rows;
    int count;
    PlotTicks scenes, shares;
} Rates;

static int find_network(const char *name) {
    int i = 0;
    while (i < RATED && strcmp(rated[i], name) != 0) i++;
    return i;
}

static void rates_panel(const void *of, int panel, PlotPanel *out) {
    static const char *const titles[DEFINITIONS] = {"Within 5% of the output's range", "Within 0.1 m/s",
                                                    "Bodies right, by the reference"};
    static const char *const labels[PHASES_SHOWN] = {"Right at impacts (%)", "Right at rest (%)"};
    const Rates *rates = of;
    const int phase = panel / DEFINITIONS;
    out->title = phase == 0 ? titles[panel] : NULL;
    out->x = plot_linear_axis(-0.5, PAPER_SCENES - 0.5, phase == 0 ? NULL : "");
    out->x.ticks = &rates->scenes;
    out->y = plot_linear_axis(-3, 104, panel % DEFINITIONS == 0 ? labels[phase] : NULL);
    out->y.ticks = &rates->shares;
}

static PlotLook rates_look(const void *of, int series) {
    static const char *const engines[SWEEPS] = {"engine, 1 sweep", "engine, 4 sweeps", "engine, 10 sweeps"};
    (void)of;
    if (series < RATED) {
        PlotLook look = plot_look(series, rated[series]);
        look.stems = true;
        look.line = 2.5;
        return look;
    }
    if (series == BAND) return (PlotLook){.name = "the paper's 60 to 91%", .style = {.colour = 0xE4E4E4}, .band = true};
    const bool constant = series == RATES_CONSTANT;
    return (PlotLook){.name = constant ? "predicting the mean" : engines[series - ENGINES],
                      .style = {.symbol = constant ? PLOT_LEVEL : PLOT_PLUS + series - ENGINES,
                                .colour = constant ? 0x000000 : PLOT_GREY},
                      .marks = true,
                      .above = true};
}

/* Networks are side by side within their scene; each has its own constant predictor and engine. */
static bool rates_point(const void *of, int panel, int series, int i, PlotPoint *out) {
    const Rates *rates = of;
    const RateRow *row = &rates->rows[i];
    if (series == BAND) return plot_level(out, i, i == 0 ? paper_least : paper_most);
    if (row->definition != panel % DEFINITIONS || row->phase != phases[panel / DEFINITIONS]) return false;
    const int network = find_network(row->network);
    const int share = series < RATED             ? RATE_NETWORK
                      : series == RATES_CONSTANT ? RATE_CONSTANT
                                                 : RATE_ENGINE1 + series - ENGINES;
    *out = (PlotPoint){row->scene + 0.2 * (network - (RATED - 1) / 2.0), 100 * row->share[share], 0};
    return series >= RATED || network == series;
}

static void keep_shown(Rates *rates, RateRow *rows, int count) {
    rates->rows = rows;
    for (int i = 0; i < count; i++) {
        if (find_network(rows[i].network) == RATED) continue;
        if (rows[i].phase == PHASE_IMPACT || rows[i].phase == PHASE_REST) rows[rates->count++] = rows[i];
    }
}

static void make_ticks(Rates *rates) {
    static const char *const names[PAPER_SCENES] = {"single", "stack", "pyramid", "pyramid,\nsettled"};
    char text[12];
    for (int scene = 0; scene < PAPER_SCENES; scene++) plot_tick_add(&rates->scenes, scene, false, names[scene]);
    for (int share = 0; share <= 100; share += 20) {
        snprintf(text, sizeof text, "%d", share);
        plot_tick_add(&rates->shares, share, false, text);
    }
}

static bool plot_rates(const CsvTable *table, PlotPage *page, Error *error) {
    Rates rates = {0};
    keep_shown(&rates, table->rows, table->count);
    make_ticks(&rates);
    const PlotSpec spec = {
        .of = &rates,
        .grid = {FIGURE_PAGE_WIDTH, 105.5, 13.5, 2, 20.5, 6, DEFINITIONS, PHASES_SHOWN, .gap = 4, .row_gap = 5},
        .panels = PHASES_SHOWN * DEFINITIONS,
        .series = RATES_SERIES,
        .rows = rates.count,
        .panel = rates_panel,
        .look = rates_look,
        .point = rates_point,
        .legend_columns = RATED,
        .legend_left = 13.5,
        .legend_top = 6 + LEGEND_ROW,
        .caption = "Share of right predictions in each scene by three definitions, at impacts and at rest. Beside each "
                   "network: the constant predictor (bar) and the engine with 1, 4 and 10 sweeps (crosses). Grey band: "
                   "the paper's 60 to 91%."};
    return rates.count == 0 || plot_draw(page, &spec, table->csv.path, error);
}

/* Three panels, one per target: the paper does not state which of them its Table 1 is about. */

enum { LOSS_PANELS = 3, LOSS_NETWORKS = 12, PUBLISHED = PAPER_OPTIMIZERS, LOSS_CONSTANT, LOSS_SERIES };

/* The networks that differ from the baseline only in target or optimizer: one of each pair. */
static const char *const loss_networks[LOSS_NETWORKS] = {
    "baseline", "target-net", "target-impulse", "optimizer-gd", "optimizer-bfgs", "optimizer-lm",
    "net-gd",   "net-bfgs",   "net-lm",         "impulse-gd",   "impulse-bfgs",   "impulse-lm"};

/* Limits of the axis: a training that diverged would squeeze the others. */
static const double least_error = 1e-8, most_error = 10;

static bool is_shown(const ScoreRow *row) {
    for (int i = 0; i < LOSS_NETWORKS; i++)
        if (strcmp(row->network, loss_networks[i]) == 0) return row->target < LOSS_PANELS;
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

static void loss_panel(const void *of, int panel, PlotPanel *out) {
    static const char *const titles[LOSS_PANELS] = {"Pair: change by its own impulses", "Net: change by all impulses",
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
    out->title = titles[panel];
    out->x = plot_range_axis(x, 1, 1e6, true, "Training iteration");
    out->y = plot_range_axis(y, least_error, most_error, false, panel == 0 ? "Mean squared error" : NULL);
}

static PlotLook loss_look(const void *of, int series) {
    static const char *const optimizers[] = {"Adam", "gradient descent", "BFGS", "Levenberg-Marquardt"};
    (void)of;
    if (series == LOSS_CONSTANT) return plot_look_dashed("predicting the mean");
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

static bool loss_point(const void *of, int panel, int series, int i, PlotPoint *out) {
    const Loss *loss = of;
    const ScoreRow *row = &loss->rows[i];
    if (series == LOSS_CONSTANT) return plot_level(out, i, constant_of(loss, panel));
    if (series == PUBLISHED) {
        if (i < PUBLISHED_SCORES) *out = (PlotPoint){published_scores[i].iteration, published_scores[i].test, 0};
        return i < PUBLISHED_SCORES;
    }
    if (i >= loss->count) return false;
    *out = (PlotPoint){row->iteration, row->test, 0};
    return row->target == panel && row->optimizer == series;
}

static bool plot_loss(const CsvTable *table, PlotPage *page, Error *error) {
    ScoreRow *rows = table->rows;
    Loss loss = {.rows = rows};
    for (int i = 0; i < table->count; i++)
        if (is_shown(&rows[i])) rows[loss.count++] = rows[i];
    if (loss.count > 0) qsort(rows, (size_t)loss.count, sizeof *rows, compare_rows);
    const PlotSpec spec = {
        .of = &loss,
        .grid = {FIGURE_PAGE_WIDTH, 72, 13.5, 2, 17.5, 6, LOSS_PANELS, 1, .gap = 4.5},
        .panels = LOSS_PANELS,
        .series = LOSS_SERIES,
        .rows = loss.count + PUBLISHED_SCORES,
        .panel = loss_panel,
        .look = loss_look,
        .point = loss_point,
        .legend_columns = 3,
        .legend_left = 13.5,
        .legend_top = 6,
        .caption = "Mean squared error of the normalised outputs on test rows over training iterations (0: before "
                   "training), for each reading of the target. Dashed: the constant predictor. The paper's own errors "
                   "are in each panel, as the paper does not state which target they are for."};
    return loss.count == 0 || plot_draw(page, &spec, table->csv.path, error);
}

/* Laws in the loss: the test error on the left, the violation of each law on the right. */

/* Panels: the error, then each law. Series: all laws and each law alone; the reference. */
enum { ERROR_PANEL, LAW_PANELS = 1 + LAWS, REFERENCE = LAW_SET_ALL + 1, LAW_SERIES };

/* The panels of the laws; the one of the error is as high as all of them. */
static const PlotGrid law_grid = {FIGURE_PAGE_WIDTH, 97, 84, 3, 17.8, 6, 2, LAWS / 2, .gap = 10, .row_gap = 7.5};
static const double error_left = 13.5, error_width = 56; /* mm */

/* Limits of violations; and the lowest one shown, as a share of the highest. */
static const double least_violation = 1e-12, most_violation = 1e12, share_shown = 1e-6;

/* The value in a panel: the violation of its law, or the error over the constant predictor's. */
static double plots_measure(const LawRow *row, int panel) {
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
        plot_range_include(&range, plots_measure(&rows[i], panel));
        zero |= plots_measure(&rows[i], panel) == 0;
    }
    if (panel == ERROR_PANEL) return error_axis(range);
    if (!(range.most > 0)) range = (PlotRange){0.1, 1};
    const double lowest = fmax(least_violation, fmin(range.most, most_violation) * share_shown);
    PlotAxis axis = plot_range_axis(range, lowest, most_violation, zero, panel % 2 == 1 ? "Mean violation" : "");
    axis.powers = true;
    return axis;
}

static void laws_panel(const void *of, int panel, PlotPanel *out) {
    static const char *const titles[LAW_PANELS] = {"Error", "Momentum (kg m/s)", "Energy (J)", "Approach (m/s)",
                                                   "Friction cone (N s)"};
    const CsvTable *table = of;
    const LawRow *rows = table->rows;
    PlotRange weights = plot_range();
    for (int i = 0; i < table->count; i++)
        if (rows[i].laws <= LAW_SET_ALL) plot_range_include(&weights, rows[i].weight);
    out->box = panel == ERROR_PANEL ? (PlotBox){error_left, law_grid.bottom, error_width,
                                                law_grid.height - law_grid.bottom - law_grid.top}
                                    : plot_grid_box(&law_grid, panel - 1);
    out->title = titles[panel];
    out->x = plot_range_axis(weights, 1e-9, 1e9, true, panel == 1 || panel == 2 ? NULL : "Weight in the loss");
    out->y = axis_of(table, panel);
}

static PlotLook laws_look(const void *of, int series) {
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
        if (panel != ERROR_PANEL && rows[i].laws == LAW_SET_ENGINE) value = plots_measure(&rows[i], panel);
    return value;
}

/* Each line begins with the networks without laws, at weight 0. */
static bool laws_point(const void *of, int panel, int series, int i, PlotPoint *out) {
    const CsvTable *table = of;
    const LawRow *row = (const LawRow *)table->rows + i;
    if (series == REFERENCE) return plot_level(out, i, reference_of(table, panel));
    const bool none = row->laws == LAW_SET_NONE;
    *out = (PlotPoint){none ? 0 : row->weight, plots_measure(row, panel), isnan(row->seed) ? 0 : row->seed};
    return is_in(series, panel) && is_used(table, series) && (none || row->laws == series);
}

static bool plot_laws(const CsvTable *table, PlotPage *page, Error *error) {
    bool used = false;
    const PlotSpec spec = {
        .of = table,
        .grid = law_grid,
        .panels = LAW_PANELS,
        .series = LAW_SERIES,
        .rows = table->count,
        .panel = laws_panel,
        .look = laws_look,
        .point = laws_point,
        .legend_columns = 3,
        .legend_left = error_left,
        .legend_top = 6.2,
        .caption =
            "Laws of physics in the loss, over their weight (0: without). Left: test error over that of the "
            "constant predictor. Right: mean violation of each law on the test rows, with only that law and with "
            "all four; dashed: the engine's own solution. Thin: one seed each; thick: their median."};
    for (int line = 0; line <= LAW_SET_ALL; line++) used |= is_used(table, line);
    return !used || plot_draw(page, &spec, table->csv.path, error);
}

/* A plot in progress. All tables are read before the first picture is written. */
typedef struct Plot {
    const char *name;
    const CsvLayout *layout;
    PlotWrite *write;
} Plot;

static const Plot plots[] = {
    {.name = "loss", .layout = &paper_score_layout, .write = plot_loss},
    {.name = "factors", .layout = &paper_trained_layout, .write = plot_factors},
    {.name = "rates", .layout = &paper_rate_layout, .write = plot_rates},
    {.name = "closed-loop", .layout = &paper_closed_loop_layout, .write = plot_closed_loop},
    {.name = "laws", .layout = &paper_law_layout, .write = plot_laws},
    {.name = "transfer", .layout = &paper_transfer_layout, .write = plot_transfer},
};

enum { RESULTS = sizeof plots / sizeof *plots };

static bool make_page(const Plot *plot, const char *folder, PlotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, plot->layout, error)) return false;
    const bool made = plot->write(&table, page, error);
    csv_table_free(&table);
    return made;
}

bool plots_draw(const char *folder, const Progress *progress, Error *error) {
    char path[PATH_MAX];
    if (!file_path(path, sizeof path, error, "%s/figures", folder)) return false;
    PlotPage pages[RESULTS];
    memset(pages, 0, sizeof pages);
    bool done = true;
    for (int i = 0; done && i < RESULTS; i++) done = make_page(&plots[i], folder, &pages[i], error);
    done = done && file_make_directory(path, error);
    for (int i = 0; done && i < RESULTS; i++)
        done = (progress_report(progress, i, RESULTS) ||
                error_interrupted(error, path, "stopped; the tables are finished")) &&
               plot_page_write(&pages[i], path, "", plots[i].name, error);
    for (int i = 0; i < RESULTS; i++) plot_page_free(&pages[i]);
    return done;
}
