/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Three definitions of a right prediction side by side; impacts above, rest below. */
#include "chart/figure_axis.h"
#include "paper/figures/plot_parts.h"
#include "paper/study/paper_tables.h"

#include <stdlib.h>
#include <string.h>

enum { DEFINITIONS = RATE_DEFINITIONS, NETWORKS = 4, SWEEPS = 3 };

enum { SHOWN_PHASES = 2 };
static const int shown_phases[SHOWN_PHASES] = {PHASE_IMPACT, PHASE_REST};
static const char *const networks[NETWORKS] = {"baseline", "target-net", "target-impulse", "contact-net"};
static const char *const titles[DEFINITIONS] = {"Within 5% of the output's range", "Within 0.1 m/s",
                                                "Bodies right, by the reference"};
static const char *const labels[SHOWN_PHASES] = {"Right at impacts (%)", "Right at rest (%)"};

/* mm */
static const double panel_height = 37, left = 13.5, right = 2, gap = 4, row_gap = 5, bottom = 20.5, top = 6,
                    legend_top = 6;

/* The paper's prediction rates, %. */
static const double paper_least = 60, paper_most = 91;

/* Half sizes of a stem and of the constant predictor's bar, in units of the axes. */
static const double stem = 0.017, bar_width = 0.08, bar_height = 0.8;

typedef struct Rates {
    FigurePage *page;
    const RateRow *rows;
    int count;
    bool used[NETWORKS];
} Rates;

static int find_network(const char *name) {
    int i = 0;
    while (i < NETWORKS && strcmp(networks[i], name) != 0) i++;
    return i;
}

/* Networks side by side within their scene. */
static double place(const RateRow *row) {
    return row->scene + 0.2 * (find_network(row->network) - (NETWORKS - 1) / 2.0);
}

static bool is_in(const RateRow *row, int definition, int phase) {
    return row->definition == definition && row->phase == shown_phases[phase];
}

static FigureLook stem_look(int network) {
    FigureLook look = figure_look(network, networks[network]);
    look.style.dashes = "solid";
    return look;
}

static FigureLook engine_look(int i) {
    static const char *const names[SWEEPS] = {"engine, 1 sweep", "engine, 4 sweeps", "engine, 10 sweeps"};
    FigureLook look = figure_marks(figure_look(12 + i, names[i]));
    look.style.colour = FIGURE_GREY;
    return look;
}

static FigureLook constant_look(void) {
    return (FigureLook){
        "predicting the mean", {.colour = "black", .ink = "black", .dashes = "solid"}, 0, false, 0.6, false};
}

static FigureLook band_look(void) {
    return (FigureLook){
        "the paper's 60 to 91%", {.colour = "#E4E4E4", .ink = "#E4E4E4", .dashes = "solid"}, 0, false, 2.4, false};
}

static void draw_band(const Rates *rates) {
    FigureLook look = band_look();
    figure_series(rates->page);
    figure_bar(rates->page, -0.5, paper_least, PAPER_SCENES - 0.5, paper_most);
    figure_draw(rates->page, &look);
}

static void draw_network(const Rates *rates, int network, int definition, int phase) {
    FigureLook stems = stem_look(network), marks = figure_marks(stems);
    stems.marks = false;
    for (int heads = 0; heads <= 1; heads++) {
        figure_series(rates->page);
        for (int i = 0; i < rates->count; i++) {
            const RateRow *row = &rates->rows[i];
            if (!is_in(row, definition, phase) || find_network(row->network) != network) continue;
            if (heads)
                figure_point(rates->page, place(row), 100 * row->share[RATE_NETWORK]);
            else
                figure_bar(rates->page, place(row) - stem, 0, place(row) + stem, 100 * row->share[RATE_NETWORK]);
        }
        figure_draw(rates->page, heads ? &marks : &stems);
    }
}

static void draw_constants(const Rates *rates, int definition, int phase) {
    FigureLook look = constant_look();
    figure_series(rates->page);
    for (int i = 0; i < rates->count; i++) {
        const RateRow *row = &rates->rows[i];
        if (!is_in(row, definition, phase)) continue;
        figure_bar(rates->page, place(row) - bar_width, 100 * row->share[RATE_CONSTANT] - bar_height,
                   place(row) + bar_width, 100 * row->share[RATE_CONSTANT] + bar_height);
    }
    figure_draw(rates->page, &look);
}

static void draw_engines(const Rates *rates, int definition, int phase) {
    for (int k = 0; k < SWEEPS; k++) {
        FigureLook look = engine_look(k);
        figure_series(rates->page);
        for (int i = 0; i < rates->count; i++)
            if (is_in(&rates->rows[i], definition, phase))
                figure_point(rates->page, place(&rates->rows[i]), 100 * rates->rows[i].share[RATE_ENGINE1 + k]);
        figure_draw(rates->page, &look);
    }
}

static void draw_panel(const Rates *rates, int definition, int phase) {
    FigurePage *page = rates->page;
    double width = (FIGURE_PAGE_WIDTH - left - right - gap * (DEFINITIONS - 1)) / DEFINITIONS;
    double up = bottom + (SHOWN_PHASES - 1 - phase) * (panel_height + row_gap);
    figure_panel(page, (FigureBox){left + definition * (width + gap), up, width, panel_height},
                 phase == 0 ? titles[definition] : "");
    figure_linear(page, 'x', -0.5, PAPER_SCENES - 0.5,
                  phase == 0 ? "('' 0, '' 1, '' 2, '' 3)"
                             : "('single' 0, 'stack' 1, 'pyramid' 2, \"pyramid,\\nsettled\" 3)",
                  NULL);
    figure_linear(page, 'y', -3, 104, definition == 0 ? "0,20,100" : "format '' 0,20,100",
                  definition == 0 ? labels[phase] : NULL);
    draw_band(rates);
    for (int i = 0; i < NETWORKS; i++) draw_network(rates, i, definition, phase);
    draw_constants(rates, definition, phase);
    draw_engines(rates, definition, phase);
    figure_panel_end(page);
}

static void draw_legend(const Rates *rates) {
    FigureLook looks[NETWORKS + SWEEPS + 2];
    int count = 0;
    for (int i = 0; i < NETWORKS; i++)
        if (rates->used[i]) looks[count++] = stem_look(i);
    for (int k = 0; k < SWEEPS; k++) looks[count++] = engine_look(k);
    looks[count++] = constant_look();
    looks[count++] = band_look();
    figure_legend(rates->page, looks, count, NETWORKS, left, legend_top + FIGURE_LEGEND_ROW);
}

static void keep_shown(Rates *rates, RateRow *rows, int count) {
    rates->rows = rows;
    for (int i = 0; i < count; i++) {
        int network = find_network(rows[i].network);
        if (network == NETWORKS || (rows[i].phase != PHASE_IMPACT && rows[i].phase != PHASE_REST)) continue;
        rates->used[network] = true;
        rows[rates->count++] = rows[i];
    }
}

bool plot_rates(const char *folder, FigurePage *page, Error *error) {
    Rates rates = {.page = page};
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &paper_rate_layout, error)) return false;
    keep_shown(&rates, table.rows, table.count);
    if (rates.count > 0) {
        figure_begin(page, FIGURE_PAGE_WIDTH, bottom + 2 * panel_height + row_gap + top);
        for (int phase = 0; phase < SHOWN_PHASES; phase++)
            for (int definition = 0; definition < DEFINITIONS; definition++) draw_panel(&rates, definition, phase);
        draw_legend(&rates);
        fprintf(page->caption,
                "Share of right predictions in each scene by three definitions, at impacts and at rest. Beside each "
                "network: the constant predictor (bar) and the engine with 1, 4 and 10 sweeps (crosses). Grey band: "
                "the paper's 60 to 91%%.");
        figure_end(page);
    }
    csv_table_free(&table);
    return true;
}
