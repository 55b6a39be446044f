/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A dot plot in two columns, one line per network, grouped by factor. */
#include "chart/gnuplot_axis.h"
#include "paper/figures/plot_parts.h"
#include "paper/study/aims.h"
#include "paper/study/paper_tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HALVES = 2, LABEL_MAX = 30 };

/* mm */
static const double row_height = 3.3, half_width = FIGURE_PAGE_WIDTH / HALVES, plot_left = 36, plot_width = 39,
                    numbers_right = 85, bottom = 17.5, top = 6, legend_top = 6, aim_width = 0.6;

/* In rows. */
static const double group_gap = 0.7, aim_height = 0.86;

static const double least_ratio = 1e-4, most_ratio = 100;

static bool same_factor(const TrainedRow *a, const TrainedRow *b) { return strcmp(a->factor, b->factor) == 0; }

/* Rows grouped by factor, factors in the order of their first rows. The caller frees them; NULL if out of memory. */
static TrainedRow *group_rows(const TrainedRow *rows, int count) {
    TrainedRow *grouped = malloc((size_t)count * sizeof *grouped);
    int grouped_count = 0;
    for (int i = 0; grouped != NULL && i < count; i++) {
        int first = 0;
        while (!same_factor(&rows[first], &rows[i])) first++;
        for (int k = i; first == i && k < count; k++)
            if (same_factor(&rows[k], &rows[i])) grouped[grouped_count++] = rows[k];
    }
    return grouped;
}

/* Height of rows [begin, end), in rows. */
static double span_of(const TrainedRow *rows, int begin, int end) {
    double span = 0.3 + (end - begin);
    for (int i = begin + 1; i < end; i++) span += same_factor(&rows[i], &rows[i - 1]) ? 0 : group_gap;
    return span;
}

/* Index of the first row of the second half: the start of a group, such that the higher half is as low as possible. */
static int split(const TrainedRow *rows, int count, double *span) {
    int best = count;
    *span = span_of(rows, 0, count);
    for (int i = 1; i < count; i++) {
        if (same_factor(&rows[i], &rows[i - 1])) continue;
        double higher = fmax(span_of(rows, 0, i), span_of(rows, i, count));
        if (higher >= *span) continue;
        *span = higher;
        best = i;
    }
    return best;
}

typedef struct Factors {
    GnuplotPage *page;
    const TrainedRow *rows;
    int begin, end; /* of the half */
    GnuplotAxis x;
    double span; /* of the higher half, in rows */
} Factors;

static GnuplotLook guide_look(void) {
    return (GnuplotLook){"", {.colour = "#C8C8C8", .ink = "#C8C8C8", .dashes = "solid"}, 0.6, false, 0, false};
}

static GnuplotLook aim_look(void) {
    return (GnuplotLook){
        "aim for the best", {.colour = "black", .ink = "black", .dashes = "solid"}, 0, false, aim_width, true};
}

/* Places of rows, from 0 downwards. */
static double next_place(const Factors *factors, int i, double place) {
    if (i == factors->begin) return 0.65;
    return place + 1 + (same_factor(&factors->rows[i], &factors->rows[i - 1]) ? 0 : group_gap);
}

static void draw_guides(const Factors *factors) {
    GnuplotLook guide = guide_look(), constant = gnuplot_look_dashed("");
    double place = 0;
    gnuplot_series_begin(factors->page);
    for (int i = factors->begin; i < factors->end; i++) {
        place = next_place(factors, i, place);
        if (isnan(factors->rows[i].ratio)) continue;
        gnuplot_segment(factors->page, factors->x.log.low, place, factors->x.log.high, place);
    }
    gnuplot_series_end(factors->page, &guide);
    gnuplot_series_begin(factors->page);
    gnuplot_segment(factors->page, 1, 0, 1, factors->span);
    gnuplot_series_end(factors->page, &constant);
}

static void draw_dots(const Factors *factors, int target) {
    GnuplotLook dot = gnuplot_look_marks(gnuplot_look(target, ""));
    double place = 0;
    gnuplot_series_begin(factors->page);
    for (int i = factors->begin; i < factors->end; i++) {
        const TrainedRow *row = &factors->rows[i];
        place = next_place(factors, i, place);
        if (row->target == target)
            gnuplot_point(factors->page, gnuplot_axis_clamp(factors->page, &factors->x, row->ratio), place);
    }
    gnuplot_series_end(factors->page, &dot);
}

/* Higher than a dot, so that they can be seen behind it. */
static void draw_aims(const Factors *factors) {
    GnuplotLook look = aim_look();
    double half = pow(factors->x.log.high / factors->x.log.low, aim_width / 2 / plot_width), place = 0;
    gnuplot_series_begin(factors->page);
    for (int i = factors->begin; i < factors->end; i++) {
        const TrainedRow *row = &factors->rows[i];
        place = next_place(factors, i, place);
        double aim = target_aims[row->target];
        if (strcmp(row->factor, "best") == 0 && aim > 0)
            gnuplot_bar(factors->page, aim / half, place - aim_height / 2, aim * half, place + aim_height / 2);
    }
    gnuplot_series_end(factors->page, &look);
}

static void draw_names(const Factors *factors, double left) {
    double place = 0;
    for (int i = factors->begin; i < factors->end; i++) {
        const TrainedRow *row = &factors->rows[i];
        place = next_place(factors, i, place);
        double y = bottom + (factors->span - place) * row_height;
        char text[2 * CSV_NAME_SIZE + 4];
        bool alone = row->value[0] == '\0' || strcmp(row->factor, row->value) == 0;
        int length = snprintf(text, sizeof text, "%s%s%s", row->factor, alone ? "" : " = ", alone ? "" : row->value);
        if (length > LABEL_MAX) strcpy(text + LABEL_MAX - 3, "...");
        gnuplot_text(factors->page, left + plot_left - 1.5, y, "right", 6.5, text);
        if (isnan(row->ratio)) gnuplot_text(factors->page, left + plot_left + 1, y, "left", 6.5, "no result");
        snprintf(text, sizeof text, "%.0f", row->parameters);
        if (!isnan(row->parameters)) gnuplot_text(factors->page, left + numbers_right, y, "right", 6.5, text);
    }
}

static void draw_half(Factors *factors, int half) {
    GnuplotPage *page = factors->page;
    double left = half * half_width;
    gnuplot_panel_begin(page, (GnuplotBox){left + plot_left, bottom, plot_width, factors->span * row_height}, "");
    gnuplot_log_axis(page, 'x', &factors->x, "Test error / that of predicting the mean");
    gnuplot_linear_axis(page, 'y', factors->span, 0, "", NULL);
    gnuplot_text(page, left + numbers_right, page->height - top / 2, "right", 6.5, "parameters");
    draw_names(factors, left);
    draw_guides(factors);
    draw_aims(factors);
    for (int target = 0; target < PAIR_TARGETS; target++) draw_dots(factors, target);
    gnuplot_panel_end(page);
}

static void draw_legend(GnuplotPage *page, const TrainedRow *rows, int count) {
    static const char *const names[PAIR_TARGETS] = {"target pair", "target net", "target impulse", "target points"};
    GnuplotLook looks[PAIR_TARGETS + 2];
    int entries = 0;
    for (int target = 0; target < PAIR_TARGETS; target++) {
        bool used = false;
        for (int i = 0; i < count; i++) used |= rows[i].target == target;
        if (used) looks[entries++] = gnuplot_look_marks(gnuplot_look(target, names[target]));
    }
    looks[entries++] = aim_look();
    looks[entries++] = gnuplot_look_dashed("predicting the mean");
    gnuplot_legend(page, looks, entries, (entries + 1) / 2, plot_left, legend_top);
}

static void draw(GnuplotPage *page, const TrainedRow *rows, int count) {
    GnuplotRange range = {target_aims[TARGET_IMPULSE], 1};
    for (int i = 0; i < count; i++) gnuplot_range_include(&range, rows[i].ratio);
    Factors factors = {page, rows, 0, 0, gnuplot_axis(range, least_ratio, most_ratio, false), 0};
    int middle = split(rows, count, &factors.span);
    gnuplot_page_begin(page, FIGURE_PAGE_WIDTH, bottom + factors.span * row_height + top);
    for (int half = 0; half < HALVES; half++) {
        factors.begin = half == 0 ? 0 : middle;
        factors.end = half == 0 ? middle : count;
        if (factors.begin < factors.end) draw_half(&factors, half);
    }
    draw_legend(page, rows, count);
    fprintf(page->caption,
            "Test error of every network over that of the constant predictor (dashed: 1), by the factor in which it "
            "differs from the baseline. On the right: the number of parameters. Upright bars: the aims for the best "
            "networks, 0.4 for the targets pair and net and 0.1 for impulse.");
    gnuplot_page_end(page);
}

bool plot_factors(const char *folder, GnuplotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &paper_trained_layout, error)) return false;
    const int count = table.count;
    TrainedRow *rows = group_rows(table.rows, count);
    if (rows != NULL) draw(page, rows, count);
    free(rows);
    csv_table_free(&table);
    return rows != NULL || error_memory(error, folder);
}
