/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Three definitions of a right prediction side by side; impacts above, rest below. */
#include "chart/gnuplot_axis.h"
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
    GnuplotPage *page;
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

static GnuplotLook stem_look(int network) {
    GnuplotLook look = gnuplot_look(network, networks[network]);
    look.style.dashes = "solid";
    return look;
}

static GnuplotLook engine_look(int i) {
    static const char *const names[SWEEPS] = {"engine, 1 sweep", "engine, 4 sweeps", "engine, 10 sweeps"};
    GnuplotLook look = gnuplot_look_marks(gnuplot_look(12 + i, names[i]));
    look.style.colour = GNUPLOT_GREY;
    return look;
}

static GnuplotLook constant_look(void) {
    return (GnuplotLook){
        "predicting the mean", {.colour = "black", .ink = "black", .dashes = "solid"}, 0, false, 0.6, false};
}

static GnuplotLook band_look(void) {
    return (GnuplotLook){
        "the paper's 60 to 91%", {.colour = "#E4E4E4", .ink = "#E4E4E4", .dashes = "solid"}, 0, false, 2.4, false};
}

static void draw_band(const Rates *rates) {
    GnuplotLook look = band_look();
    gnuplot_series_begin(rates->page);
    gnuplot_bar(rates->page, -0.5, paper_least, PAPER_SCENES - 0.5, paper_most);
    gnuplot_series_end(rates->page, &look);
}

static void draw_network(const Rates *rates, int network, int definition, int phase) {
    GnuplotLook stems = stem_look(network), marks = gnuplot_look_marks(stems);
    stems.marks = false;
    for (int heads = 0; heads <= 1; heads++) {
        gnuplot_series_begin(rates->page);
        for (int i = 0; i < rates->count; i++) {
            const RateRow *row = &rates->rows[i];
            if (!is_in(row, definition, phase) || find_network(row->network) != network) continue;
            if (heads)
                gnuplot_point(rates->page, place(row), 100 * row->share[RATE_NETWORK]);
            else
                gnuplot_bar(rates->page, place(row) - stem, 0, place(row) + stem, 100 * row->share[RATE_NETWORK]);
        }
        gnuplot_series_end(rates->page, heads ? &marks : &stems);
    }
}

static void draw_constants(const Rates *rates, int definition, int phase) {
    GnuplotLook look = constant_look();
    gnuplot_series_begin(rates->page);
    for (int i = 0; i < rates->count; i++) {
        const RateRow *row = &rates->rows[i];
        if (!is_in(row, definition, phase)) continue;
        gnuplot_bar(rates->page, place(row) - bar_width, 100 * row->share[RATE_CONSTANT] - bar_height,
                    place(row) + bar_width, 100 * row->share[RATE_CONSTANT] + bar_height);
    }
    gnuplot_series_end(rates->page, &look);
}

static void draw_engines(const Rates *rates, int definition, int phase) {
    for (int k = 0; k < SWEEPS; k++) {
        GnuplotLook look = engine_look(k);
        gnuplot_series_begin(rates->page);
        for (int i = 0; i < rates->count; i++)
            if (is_in(&rates->rows[i], definition, phase))
                gnuplot_point(rates->page, place(&rates->rows[i]), 100 * rates->rows[i].share[RATE_ENGINE1 + k]);
        gnuplot_series_end(rates->page, &look);
    }
}

static void draw_panel(const Rates *rates, int definition, int phase) {
    GnuplotPage *page = rates->page;
    double width = (FIGURE_PAGE_WIDTH - left - right - gap * (DEFINITIONS - 1)) / DEFINITIONS;
    double up = bottom + (SHOWN_PHASES - 1 - phase) * (panel_height + row_gap);
    gnuplot_panel_begin(page, (GnuplotBox){left + definition * (width + gap), up, width, panel_height},
                        phase == 0 ? titles[definition] : "");
    gnuplot_linear_axis(page, 'x', -0.5, PAPER_SCENES - 0.5,
                        phase == 0 ? "('' 0, '' 1, '' 2, '' 3)"
                                   : "('single' 0, 'stack' 1, 'pyramid' 2, \"pyramid,\\nsettled\" 3)",
                        NULL);
    gnuplot_linear_axis(page, 'y', -3, 104, definition == 0 ? "0,20,100" : "format '' 0,20,100",
                        definition == 0 ? labels[phase] : NULL);
    draw_band(rates);
    for (int i = 0; i < NETWORKS; i++) draw_network(rates, i, definition, phase);
    draw_constants(rates, definition, phase);
    draw_engines(rates, definition, phase);
    gnuplot_panel_end(page);
}

static void draw_legend(const Rates *rates) {
    GnuplotLook looks[NETWORKS + SWEEPS + 2];
    int count = 0;
    for (int i = 0; i < NETWORKS; i++)
        if (rates->used[i]) looks[count++] = stem_look(i);
    for (int k = 0; k < SWEEPS; k++) looks[count++] = engine_look(k);
    looks[count++] = constant_look();
    looks[count++] = band_look();
    gnuplot_legend(rates->page, looks, count, NETWORKS, left, legend_top + GNUPLOT_LEGEND_ROW);
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

bool plot_rates(const char *folder, GnuplotPage *page, Error *error) {
    Rates rates = {.page = page};
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &paper_rate_layout, error)) return false;
    keep_shown(&rates, table.rows, table.count);
    if (rates.count > 0) {
        gnuplot_page_begin(page, FIGURE_PAGE_WIDTH, bottom + 2 * panel_height + row_gap + top);
        for (int phase = 0; phase < SHOWN_PHASES; phase++)
            for (int definition = 0; definition < DEFINITIONS; definition++) draw_panel(&rates, definition, phase);
        draw_legend(&rates);
        fprintf(page->caption,
                "Share of right predictions in each scene by three definitions, at impacts and at rest. Beside each "
                "network: the constant predictor (bar) and the engine with 1, 4 and 10 sweeps (crosses). Grey band: "
                "the paper's 60 to 91%%.");
        gnuplot_page_end(page);
    }
    csv_table_free(&table);
    return true;
}
