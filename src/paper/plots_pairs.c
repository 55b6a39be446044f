/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plots of the study's networks: their errors by factor, transfer, and runs in closed loop. */
#include "base/base.h"
#include "base/csv.h"
#include "figures/sketch.h"
#include "methods/pair.h"
#include "paper/paper_tables.h"
#include "paper/report_internal.h"
#include "pixels/png.h"
#include "studies/closed_loop.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A dot plot in two columns, one line per network, grouped by factor. */

enum { HALVES = 2, AIMS = PAIR_TARGETS, FACTORS_CONSTANT, FACTORS_GUIDES, FACTORS_SERIES };

/* mm */
static const double factor_height = 3.3, half_width = FIGURE_PAGE_WIDTH / HALVES, plot_left = 36, plot_width = 39,
                    numbers_right = 85, factors_bottom = 17.5, factors_top = 6;

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
static int plots_pairs_split(const TrainedRow *rows, int count, double *span) {
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

static void factors_panel(const void *of, int half, PlotPanel *out) {
    const Factors *factors = of;
    PlotRange range = {target_aims[TARGET_IMPULSE], 1};
    if (first_of(factors, half) == end_of(factors, half)) out->box.width = 0;
    for (int i = 0; i < factors->count; i++) plot_range_include(&range, factors->rows[i].ratio);
    out->x = plot_range_axis(range, least_ratio, most_ratio, false, "Test error / that of predicting the mean");
    out->y = plot_linear_axis(factors->span, 0, NULL);
    out->y.ticks = &factors->none;
}

static PlotLook factors_look(const void *of, int series) {
    static const char *const names[PAIR_TARGETS] = {"target pair", "target net", "target impulse", "target points"};
    (void)of;
    if (series == FACTORS_GUIDES) return plot_look_guide();
    if (series == FACTORS_CONSTANT) return plot_look_dashed("predicting the mean");
    if (series == AIMS) return (PlotLook){"aim for the best", {.symbol = PLOT_UPRIGHT, .colour = 0}, .marks = true};
    return plot_look_marks(series, names[series]);
}

/* The aims are higher than a dot, so that they can be seen behind it. Two points of each row: of its guide. */
static bool factors_point(const void *of, int half, int series, int i, PlotPoint *out) {
    const Factors *factors = of;
    const int index = series == FACTORS_GUIDES ? i / 2 : i;
    if (series == FACTORS_CONSTANT) return plot_upright(out, i, 1);
    if (index < first_of(factors, half) || index >= end_of(factors, half)) return false;
    const TrainedRow *row = &factors->rows[index];
    const double place = place_of(factors, half, index);
    *out = (PlotPoint){series == AIMS ? target_aims[row->target] : row->ratio, place, index};
    if (series == FACTORS_GUIDES) out->x = i % 2 == 0 ? -INFINITY : INFINITY;
    if (series == FACTORS_GUIDES) return !isnan(row->ratio);
    if (series == AIMS) return strcmp(row->factor, "best") == 0 && target_aims[row->target] > 0;
    return row->target == series;
}

/* Left of the plot the factor, right of it the number of parameters. */
static void draw_texts(const Factors *factors, Sketch *sketch, int half) {
    const double points = 6.5, left = half * half_width, name_right = left + plot_left - 1.5;
    plot_text(sketch, (Point){left + numbers_right, sketch->height - factors_top / 2}, TEXT_RIGHT, points,
              "parameters");
    for (int i = first_of(factors, half); i < end_of(factors, half); i++) {
        const TrainedRow *row = &factors->rows[i];
        const double y = factors_bottom + (factors->span - place_of(factors, half, i)) * factor_height;
        const bool alone = row->value[0] == '\0' || strcmp(row->factor, row->value) == 0;
        char text[2 * CSV_NAME_SIZE + 4];
        snprintf(text, sizeof text, "%s%s%s", row->factor, alone ? "" : " = ", alone ? "" : row->value);
        plot_text(sketch, (Point){name_right, y}, TEXT_RIGHT, text_points(text, points, plot_left - 3), text);
        if (isnan(row->ratio)) plot_text(sketch, (Point){left + plot_left + 1, y}, TEXT_LEFT, points, "no result");
        snprintf(text, sizeof text, "%.0f", row->parameters);
        if (!isnan(row->parameters)) plot_text(sketch, (Point){left + numbers_right, y}, TEXT_RIGHT, points, text);
    }
}

static bool plots_pairs_draw(Factors *factors, PlotPage *page, const char *path, Error *error) {
    factors->middle = plots_pairs_split(factors->rows, factors->count, &factors->span);
    const PlotSpec spec = {
        .of = factors,
        .grid = {FIGURE_PAGE_WIDTH, factors_bottom + factors->span * factor_height + factors_top, plot_left,
                 half_width - plot_left - plot_width, factors_bottom, factors_top, HALVES, 1,
                 .gap = half_width - plot_width},
        .panels = HALVES,
        .series = FACTORS_SERIES,
        .rows = 2 * factors->count,
        .panel = factors_panel,
        .look = factors_look,
        .point = factors_point,
        .legend_columns = 3,
        .legend_left = plot_left,
        .legend_top = 6,
        .caption =
            "Test error of every network over that of the constant predictor (dashed: 1), by the factor in which "
            "it differs from the baseline. On the right: the number of parameters. Upright bars: the aims for "
            "the best networks, 0.4 for the targets pair and net and 0.1 for impulse."};
    if (!plot_draw(page, &spec, path, error)) return false;
    for (int half = 0; half < HALVES; half++)
        if (first_of(factors, half) < end_of(factors, half)) draw_texts(factors, &page->sketch, half);
    return true;
}

bool plot_factors(const CsvTable *table, PlotPage *page, Error *error) {
    TrainedRow *rows = group_rows(table->rows, table->count);
    Factors factors = {.rows = rows, .count = table->count};
    const bool drawn =
        rows != NULL ? plots_pairs_draw(&factors, page, table->csv.path, error) : error_memory(error, table->csv.path);
    free(rows);
    return drawn;
}

/* One column wide: the error from scratch beside that after training on smaller scenes. */

enum { STARTS = 2, TRANSFER_CONSTANT = STARTS, TRANSFER_SERIES };

static const double least_error = 1e-6;

static PlotLook transfer_look(const void *of, int series) {
    static const char *const names[STARTS] = {"from scratch", "after single and stack"};
    (void)of;
    PlotLook look =
        series == TRANSFER_CONSTANT ? plot_look_dashed("predicting the mean") : plot_look(series, names[series]);
    look.medians = true;
    look.seeds = series < STARTS;
    return look;
}

static bool transfer_point(const void *of, int panel, int series, int i, PlotPoint *out) {
    const TransferRow *row = (const TransferRow *)((const CsvTable *)of)->rows + i;
    (void)panel;
    *out = (PlotPoint){row->launches, series == TRANSFER_CONSTANT ? row->constant : row->error, row->seed};
    return series == TRANSFER_CONSTANT || row->transfer == series;
}

static void transfer_panel(const void *of, int panel, PlotPanel *out) {
    const CsvTable *table = of;
    const TransferRow *rows = table->rows;
    double least = PAPER_MAX_LAUNCHES, most = 1, error = least_error;
    (void)panel;
    for (int i = 0; i < table->count; i++) {
        least = fmin(least, rows[i].launches);
        most = fmax(most, rows[i].launches);
        error = fmax(error, fmax(rows[i].error, rows[i].constant)); /* of a number and NAN, the number */
    }
    const double margin = most > 4 * least ? 1.3 : 2;
    out->x = plot_linear_axis(least / margin, most * margin, "Launches of the pyramid");
    out->x.scale = PLOT_DOUBLING;
    out->y = plot_linear_axis(0, error * 1.08, "RMS velocity error (m/s)");
}

bool plot_transfer(const CsvTable *table, PlotPage *page, Error *error) {
    const PlotSpec spec = {
        .of = table,
        .grid = {FIGURE_COLUMN_WIDTH, 64, 13, 2, 17.8, 3, 1, 1, 0, 0},
        .panels = 1,
        .series = TRANSFER_SERIES,
        .rows = table->count,
        .panel = transfer_panel,
        .look = transfer_look,
        .point = transfer_point,
        .legend_columns = 2,
        .legend_left = 3,
        .legend_top = 6.2,
        .caption =
            "Error on held-out launches of the pyramid, over the number of launches that a network was trained "
            "on: from scratch, and after the single box and the stack. Thin: one seed each; thick: their median. "
            "Dashed: the constant predictor."};
    return plot_draw(page, &spec, table->csv.path, error);
}

/* One line per network, one symbol per scene: frames until divergence, and the cost of a step. */

enum { COSTS = 1, PANELS, LOOP_GUIDES = PAPER_SCENES, DASHED, LOOP_SERIES };

/* mm */
static const double loop_height = 6, loop_left = 36, frames_width = 76, gap = 6, loop_right = 3, loop_bottom = 15,
                    loop_top = 6;

typedef struct Loop {
    const ClosedLoopRow *rows;
    int count, lines;
    int line[PAPER_MAX_LOOPS]; /* of each row, from the top, from 0 */
    PlotTicks none;
} Loop;

static double value_of(const ClosedLoopRow *row, int panel) {
    return panel == COSTS ? row->us_step / row->us_step_engine : row->frames_until_apart;
}

/* Networks in the order of their first rows. */
static void number_lines(Loop *loop) {
    for (int i = 0; i < loop->count; i++) {
        int first = 0;
        while (strcmp(loop->rows[first].network, loop->rows[i].network) != 0) first++;
        loop->line[i] = first < i ? loop->line[first] : loop->lines++;
    }
}

static void loop_panel(const void *of, int panel, PlotPanel *out) {
    const Loop *loop = of;
    PlotRange costs = {1, 1};
    for (int i = 0; i < loop->count; i++) plot_range_include(&costs, value_of(&loop->rows[i], COSTS));
    out->box.left = loop_left + panel * (frames_width + gap);
    out->box.width = panel == COSTS ? FIGURE_PAGE_WIDTH - out->box.left - loop_right : frames_width;
    out->title = panel == COSTS ? "Cost" : "In place of the solver";
    out->x = panel == COSTS ? plot_range_axis(costs, 1e-3, 1e4, false, "Step time / the engine's")
                            : plot_range_axis((PlotRange){1, CLOSED_LOOP_FRAMES}, 1, CLOSED_LOOP_FRAMES, false,
                                              "Frames until divergence by 0.1 m (600: never)");
    out->y = plot_linear_axis(loop->lines - 0.5, -0.5, NULL);
    out->y.ticks = &loop->none;
}

static PlotLook loop_look(const void *of, int series) {
    (void)of;
    return series == LOOP_GUIDES ? plot_look_guide()
           : series == DASHED    ? plot_look_dashed(NULL)
                                 : plot_look_marks(series, paper_scene_titles[series]);
}

/* Scenes are offset, so that equal values do not hide each other. */
static bool loop_point(const void *of, int panel, int series, int i, PlotPoint *out) {
    const Loop *loop = of;
    if (series == DASHED) return plot_upright(out, i, panel == COSTS ? 1 : CLOSED_LOOP_FRAMES);
    if (series == LOOP_GUIDES) {
        *out = (PlotPoint){i % 2 == 0 ? -INFINITY : INFINITY, i / 2 + 0.5, i / 2};
        return i < 2 * (loop->lines - 1);
    }
    if (i >= loop->count || loop->rows[i].scene != series) return false;
    *out = (PlotPoint){value_of(&loop->rows[i], panel), loop->line[i] + 0.23 * (series - (PAPER_SCENES - 1) / 2.0), 0};
    return true;
}

static void draw_names(const Loop *loop, Sketch *sketch) {
    for (int i = 0, next = 0; i < loop->count; i++) {
        if (loop->line[i] != next) continue;
        const char *name = loop->rows[i].network;
        plot_text(sketch, (Point){loop_left - 1.5, loop_bottom + (loop->lines - next++ - 0.5) * loop_height},
                  TEXT_RIGHT, text_points(name, 7, loop_left - 3), name);
    }
}

bool plot_closed_loop(const CsvTable *table, PlotPage *page, Error *error) {
    Loop loop = {.rows = table->rows, .count = table->count};
    number_lines(&loop);
    const PlotSpec spec = {
        .of = &loop,
        .grid = {FIGURE_PAGE_WIDTH, loop_bottom + loop.lines * loop_height + loop_top, loop_left, loop_right,
                 loop_bottom, loop_top, PANELS, 1, gap, 0},
        .panels = PANELS,
        .series = LOOP_SERIES,
        .rows = 2 * loop.count,
        .panel = loop_panel,
        .look = loop_look,
        .point = loop_point,
        .legend_columns = PAPER_SCENES,
        .legend_left = loop_left,
        .legend_top = 2.7,
        .caption =
            "Networks and solvers in closed loop. Left: frames until a body is 0.1 m from its place in the converged "
            "run "
            "(600, dashed: never). Right: time of a step over that of the engine with its own solver (dashed: equal)."};
    if (!plot_draw(page, &spec, table->csv.path, error)) return false;
    draw_names(&loop, &page->sketch);
    return true;
}
