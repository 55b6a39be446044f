/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A dot plot in two columns, one line per network, grouped by factor. */
#include "paper/figures/plot_parts.h"
#include "paper/study/aims.h"
#include "paper/study/paper_tables.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { HALVES = 2, AIMS = PAIR_TARGETS, CONSTANT, GUIDES, SERIES };

/* mm */
static const double row_height = 3.3, half_width = FIGURE_PAGE_WIDTH / HALVES, plot_left = 36, plot_width = 39,
                    numbers_right = 85, bottom = 17.5, top = 6;

static const double group_gap = 0.7; /* in rows */

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
    const TrainedRow *rows;
    int count, middle; /* first row of the second half */
    double span;       /* of the higher half, in rows */
    PlotTicks none;
} Factors;

static int first_of(const Factors *factors, int half) { return half == 0 ? 0 : factors->middle; }

static int end_of(const Factors *factors, int half) { return half == 0 ? factors->middle : factors->count; }

/* The place of a row in its half, from 0 downwards. */
static double place_of(const Factors *factors, int half, int row) {
    double place = 0.65;
    for (int i = first_of(factors, half) + 1; i <= row; i++)
        place += 1 + (same_factor(&factors->rows[i], &factors->rows[i - 1]) ? 0 : group_gap);
    return place;
}

static void panel_of(const void *of, int half, PlotPanel *out) {
    const Factors *factors = of;
    PlotRange range = {target_aims[TARGET_IMPULSE], 1};
    if (first_of(factors, half) == end_of(factors, half)) return;
    for (int i = 0; i < factors->count; i++) plot_range_include(&range, factors->rows[i].ratio);
    out->box = (PlotBox){half * half_width + plot_left, bottom, plot_width, factors->span * row_height};
    out->x = plot_range_axis(range, least_ratio, most_ratio, false, "Test error / that of predicting the mean");
    out->y = plot_linear_axis(factors->span, 0, NULL);
    out->y.ticks = &factors->none;
}

static PlotLook look_of(const void *of, int series) {
    static const char *const names[PAIR_TARGETS] = {"target pair", "target net", "target impulse", "target points"};
    (void)of;
    if (series == GUIDES) return plot_look_guide();
    if (series == CONSTANT) return plot_look_dashed("predicting the mean");
    if (series == AIMS) return (PlotLook){"aim for the best", {.symbol = PLOT_UPRIGHT, .colour = 0}, .marks = true};
    return plot_look_marks(series, names[series]);
}

/* The aims are higher than a dot, so that they can be seen behind it. Two points of each row: of its guide. */
static bool point_of(const void *of, int half, int series, int i, PlotPoint *out) {
    const Factors *factors = of;
    const int index = series == GUIDES ? i / 2 : i;
    const double end = i % 2 == 0 ? -INFINITY : INFINITY;
    *out = (PlotPoint){1, end, 0};
    if (series == CONSTANT) return i < 2;
    if (index < first_of(factors, half) || index >= end_of(factors, half)) return false;
    const TrainedRow *row = &factors->rows[index];
    const double place = place_of(factors, half, index);
    *out = (PlotPoint){series == GUIDES ? end : series == AIMS ? target_aims[row->target] : row->ratio, place, index};
    if (series == GUIDES) return !isnan(row->ratio);
    if (series == AIMS) return strcmp(row->factor, "best") == 0 && target_aims[row->target] > 0;
    return row->target == series;
}

/* Left of the plot the factor, right of it the number of parameters. */
static void draw_texts(const Factors *factors, Sketch *sketch, int half) {
    const double points = 6.5, left = half * half_width, name_right = left + plot_left - 1.5;
    plot_text(sketch, (Point){left + numbers_right, sketch->height - top / 2}, TEXT_RIGHT, points, "parameters");
    for (int i = first_of(factors, half); i < end_of(factors, half); i++) {
        const TrainedRow *row = &factors->rows[i];
        const double y = bottom + (factors->span - place_of(factors, half, i)) * row_height;
        const bool alone = row->value[0] == '\0' || strcmp(row->factor, row->value) == 0;
        char text[2 * CSV_NAME_SIZE + 4];
        snprintf(text, sizeof text, "%s%s%s", row->factor, alone ? "" : " = ", alone ? "" : row->value);
        text_fit(text, sizeof text, points, plot_left - 3);
        plot_text(sketch, (Point){name_right, y}, TEXT_RIGHT, points, text);
        if (isnan(row->ratio)) plot_text(sketch, (Point){left + plot_left + 1, y}, TEXT_LEFT, points, "no result");
        snprintf(text, sizeof text, "%.0f", row->parameters);
        if (!isnan(row->parameters)) plot_text(sketch, (Point){left + numbers_right, y}, TEXT_RIGHT, points, text);
    }
}

static bool draw(Factors *factors, PlotPage *page, const char *folder, Error *error) {
    factors->middle = split(factors->rows, factors->count, &factors->span);
    const PlotSpec spec = {
        .of = factors,
        .width = FIGURE_PAGE_WIDTH,
        .height = bottom + factors->span * row_height + top,
        .panels = HALVES,
        .series = SERIES,
        .rows = 2 * factors->count,
        .panel = panel_of,
        .look = look_of,
        .point = point_of,
        .legend_columns = 3,
        .legend_left = plot_left,
        .legend_top = 6,
        .caption =
            "Test error of every network over that of the constant predictor (dashed: 1), by the factor in which "
            "it differs from the baseline. On the right: the number of parameters. Upright bars: the aims for "
            "the best networks, 0.4 for the targets pair and net and 0.1 for impulse."};
    if (!plot_draw(page, &spec, folder, error)) return false;
    for (int half = 0; half < HALVES; half++)
        if (first_of(factors, half) < end_of(factors, half)) draw_texts(factors, &page->sketch, half);
    return true;
}

bool plot_factors(const char *folder, PlotPage *page, Error *error) {
    CsvTable table;
    if (!csv_table_read_from(&table, folder, &paper_trained_layout, error)) return false;
    TrainedRow *rows = group_rows(table.rows, table.count);
    Factors factors = {.rows = rows, .count = table.count};
    const bool drawn = rows != NULL ? draw(&factors, page, folder, error) : error_memory(error, folder);
    free(rows);
    csv_table_free(&table);
    return drawn;
}
