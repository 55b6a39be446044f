/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One column wide: the error from scratch beside that after training on smaller scenes. */
#include "chart/gnuplot_axis.h"
#include "chart/gnuplot_seeds.h"
#include "paper/figures/plot_parts.h"
#include "paper/study/paper_tables.h"

#include <math.h>
#include <stdlib.h>

enum { STARTS = 2, MAX_POWER = 20 };

_Static_assert(PAPER_MAX_LAUNCHES == 1 << MAX_POWER, "all launches have a tick");

/* mm */
static const double height = 64, left = 13, right = 2, bottom = 17.8, top = 3, legend_left = 3, legend_top = 6.2;

static const double most_labels = 8, least_error = 1e-6;

typedef struct Transfer {
    GnuplotPage *page;
    const TransferRow *rows;
    int count;
    SeedPoint *points; /* [count] room */
} Transfer;

static GnuplotLook look_of(int start) {
    static const char *const names[STARTS] = {"from scratch", "after single and stack"};
    return gnuplot_look(start, names[start]);
}

/* Points of the errors of a start; STARTS: of the constant predictor. */
static int gather(const Transfer *transfer, int start) {
    int count = 0;
    for (int i = 0; i < transfer->count; i++) {
        const TransferRow *row = &transfer->rows[i];
        double value = start < STARTS ? row->error : row->constant;
        if ((start < STARTS && row->transfer != start) || isnan(value)) continue;
        transfer->points[count++] = (SeedPoint){row->seed, row->launches, value};
    }
    return count;
}

/* Ticks at powers of two, as many as fit. */
static void draw_launches(GnuplotPage *page, double low, double high) {
    int step = (int)(log2(high / low) / most_labels) + 1;
    const char *separator = "";
    fprintf(page->script, "set logscale x 2\nset xrange [%.8g:%.8g]\nset xtics scale 0.6,0.35 (", low, high);
    for (int power = 0; power <= MAX_POWER; power += step) {
        if (1 << power < low || 1 << power > high) continue;
        fprintf(page->script, "%s'%d' %d", separator, 1 << power, 1 << power);
        separator = ", ";
    }
    fprintf(page->script, ")\n");
    gnuplot_axis_label(page, 'x', "Launches of the pyramid");
}

static void draw_axes(const Transfer *transfer) {
    double least = 1 << MAX_POWER, most = 1, error = least_error;
    for (int i = 0; i < transfer->count; i++) {
        const TransferRow *row = &transfer->rows[i];
        least = fmin(least, row->launches);
        most = fmax(most, row->launches);
        error = fmax(error, fmax(row->error, row->constant)); /* of a number and NAN, the number */
    }
    double margin = most > 4 * least ? 1.3 : 2;
    draw_launches(transfer->page, least / margin, most * margin);
    gnuplot_linear_axis(transfer->page, 'y', 0, error * 1.08, NULL, "RMS velocity error (m/s)");
}

static void draw(Transfer *transfer) {
    GnuplotPage *page = transfer->page;
    GnuplotLook looks[STARTS + 1] = {look_of(0), look_of(1), gnuplot_look_dashed("predicting the mean")};
    gnuplot_page_begin(page, FIGURE_COLUMN_WIDTH, height);
    gnuplot_panel_begin(page, (GnuplotBox){left, bottom, page->width - left - right, height - bottom - top}, "");
    draw_axes(transfer);
    gnuplot_seed_median(page, transfer->points, gather(transfer, STARTS), &looks[STARTS]);
    for (int start = 0; start < STARTS; start++)
        gnuplot_seed_lines(page, transfer->points, gather(transfer, start), &looks[start]);
    for (int start = 0; start < STARTS; start++)
        gnuplot_seed_median(page, transfer->points, gather(transfer, start), &looks[start]);
    gnuplot_panel_end(page);
    gnuplot_legend(page, looks, STARTS + 1, 2, legend_left, legend_top);
    fprintf(
        page->caption,
        "Error on held-out launches of the pyramid, over the number of launches that a network was trained on: from "
        "scratch, and after the single box and the stack. Thin: one seed each; thick: their median. Dashed: the "
        "constant predictor.");
    gnuplot_page_end(page);
}

bool plot_transfer(const char *folder, GnuplotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &paper_transfer_layout, error)) return false;
    Transfer transfer = {page, table.rows, table.count, malloc((size_t)table.count * sizeof(SeedPoint))};
    bool room = transfer.points != NULL;
    if (room) draw(&transfer);
    free(transfer.points);
    csv_table_free(&table);
    return room || error_memory(error, folder);
}
