/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Three definitions of a right prediction side by side; impacts above, rest below. */
#include "paper/figures/plot_parts.h"
#include "paper/study/paper_tables.h"

#include <math.h>
#include <string.h>

enum {
    DEFINITIONS = RATE_DEFINITIONS,
    NETWORKS = 4,
    SWEEPS = 3,
    ENGINES = NETWORKS,
    CONSTANT = ENGINES + SWEEPS,
    BAND,
    SERIES
};

enum { PHASES_SHOWN = 2, PANELS = PHASES_SHOWN * DEFINITIONS };
static const int phases[PHASES_SHOWN] = {PHASE_IMPACT, PHASE_REST};
static const char *const networks[NETWORKS] = {"baseline", "target-net", "target-impulse", "contact-net"};

static const PlotGrid grid = {.width = FIGURE_PAGE_WIDTH,
                              .height = 105.5,
                              .left = 13.5,
                              .right = 2,
                              .bottom = 20.5,
                              .top = 6,
                              .columns = DEFINITIONS,
                              .rows = PHASES_SHOWN,
                              .gap = 4,
                              .row_gap = 5};

/* The paper's prediction rates, %. */
static const double paper_least = 60, paper_most = 91;

typedef struct Rates {
    const RateRow *rows;
    int count;
    PlotTicks scenes, shares;
} Rates;

static int find_network(const char *name) {
    int i = 0;
    while (i < NETWORKS && strcmp(networks[i], name) != 0) i++;
    return i;
}

static void panel_of(const void *of, int panel, PlotPanel *out) {
    static const char *const titles[DEFINITIONS] = {"Within 5% of the output's range", "Within 0.1 m/s",
                                                    "Bodies right, by the reference"};
    static const char *const labels[PHASES_SHOWN] = {"Right at impacts (%)", "Right at rest (%)"};
    const Rates *rates = of;
    const int phase = panel / DEFINITIONS;
    out->box = plot_grid_box(&grid, panel);
    out->title = phase == 0 ? titles[panel] : NULL;
    out->x = plot_linear_axis(-0.5, PAPER_SCENES - 0.5, phase == 0 ? NULL : "");
    out->x.ticks = &rates->scenes;
    out->y = plot_linear_axis(-3, 104, panel % DEFINITIONS == 0 ? labels[phase] : NULL);
    out->y.ticks = &rates->shares;
}

static PlotLook look_of(const void *of, int series) {
    static const char *const engines[SWEEPS] = {"engine, 1 sweep", "engine, 4 sweeps", "engine, 10 sweeps"};
    (void)of;
    if (series < NETWORKS) {
        PlotLook look = plot_look(series, networks[series]);
        look.stems = true;
        look.line = 2.5;
        return look;
    }
    if (series == BAND) return (PlotLook){.name = "the paper's 60 to 91%", .style = {.colour = 0xE4E4E4}, .band = true};
    const bool constant = series == CONSTANT;
    return (PlotLook){.name = constant ? "predicting the mean" : engines[series - ENGINES],
                      .style = {.symbol = constant ? PLOT_LEVEL : PLOT_PLUS + series - ENGINES,
                                .colour = constant ? 0x000000 : PLOT_GREY},
                      .marks = true,
                      .above = true};
}

/* Networks are side by side within their scene; each has its own constant predictor and engine. */
static bool point_of(const void *of, int panel, int series, int i, PlotPoint *out) {
    const Rates *rates = of;
    const RateRow *row = &rates->rows[i];
    if (series == BAND) {
        *out = (PlotPoint){i == 0 ? -INFINITY : INFINITY, i == 0 ? paper_least : paper_most, 0};
        return i < 2;
    }
    if (row->definition != panel % DEFINITIONS || row->phase != phases[panel / DEFINITIONS]) return false;
    const int network = find_network(row->network);
    const int share = series < NETWORKS    ? RATE_NETWORK
                      : series == CONSTANT ? RATE_CONSTANT
                                           : RATE_ENGINE1 + series - ENGINES;
    *out = (PlotPoint){row->scene + 0.2 * (network - (NETWORKS - 1) / 2.0), 100 * row->share[share], 0};
    return series >= NETWORKS || network == series;
}

static void keep_shown(Rates *rates, RateRow *rows, int count) {
    rates->rows = rows;
    for (int i = 0; i < count; i++) {
        if (find_network(rows[i].network) == NETWORKS) continue;
        if (rows[i].phase == PHASE_IMPACT || rows[i].phase == PHASE_REST) rows[rates->count++] = rows[i];
    }
}

static void make_ticks(Rates *rates) {
    static const char *const names[PAPER_SCENES] = {"single", "stack", "pyramid", "pyramid,\nsettled"};
    char text[8];
    for (int scene = 0; scene < PAPER_SCENES; scene++) plot_tick_add(&rates->scenes, scene, false, names[scene]);
    for (int share = 0; share <= 100; share += 20) {
        snprintf(text, sizeof text, "%d", share);
        plot_tick_add(&rates->shares, share, false, text);
    }
}

bool plot_rates(const char *folder, PlotPage *page, Error *error) {
    static const char caption[] =
        "Share of right predictions in each scene by three definitions, at impacts and at rest. Beside each network: "
        "the constant predictor (bar) and the engine with 1, 4 and 10 sweeps (crosses). Grey band: the paper's 60 to "
        "91%.";
    Rates rates = {0};
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &paper_rate_layout, error)) return false;
    keep_shown(&rates, table.rows, table.count);
    make_ticks(&rates);
    const PlotSpec spec = {.of = &rates,
                           .width = grid.width,
                           .height = grid.height,
                           .panels = PANELS,
                           .series = SERIES,
                           .rows = rates.count,
                           .panel = panel_of,
                           .look = look_of,
                           .point = point_of,
                           .legend_columns = NETWORKS,
                           .legend_left = grid.left,
                           .legend_top = 6 + LEGEND_ROW,
                           .caption = caption};
    const bool drawn = rates.count == 0 || plot_draw(page, &spec, folder, error);
    csv_table_free(&table);
    return drawn;
}
