/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The plots of the study's networks: their errors by factor, transfer, and runs in closed loop. */
#include "base/base.h"
#include "base/csv.h"
#include "figures/plot.h"
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

enum { HALVES = 2, RANGES = PAIR_TARGETS, FACTORS_CONSTANT, FACTORS_GUIDES, FACTORS_SERIES };

/* A network over its splits: its first row, with the median ratio. */
typedef struct FactorRow {
    TrainedRow row;
    double least, most; /* ratios */
} FactorRow;

typedef struct Factors {
    FactorRow *rows; /* [count] grouped by factor, factors in the order of their first rows */
    double *places;  /* [count] of a row in its half, from 0 downwards */
    int count;
    int begin[HALVES + 1]; /* of each half */
    double span;           /* of the higher half, in rows */
} Factors;

static const double group_gap = 0.7; /* in rows */

static bool same_factor(const FactorRow *a, const FactorRow *b) { return strcmp(a->row.factor, b->row.factor) == 0; }

/* Height of rows [begin, end), in rows. */
static double span_of(const FactorRow *rows, int begin, int end) {
    double span = 0.3 + (end - begin);
    for (int i = begin + 1; i < end; i++) span += same_factor(&rows[i], &rows[i - 1]) ? 0 : group_gap;
    return span;
}

static int row_order(const void *first, const void *second) {
    const TrainedRow *a = first, *b = second;
    const int order = strcmp(a->network, b->network);
    if (order != 0) return order;
    const int known = !!isnan(a->ratio) - !!isnan(b->ratio); /* unknown ones last */
    return known != 0 ? known : (a->ratio > b->ratio) - (a->ratio < b->ratio);
}

/* Puts the splits of each network together, in the order of their networks. rows[row_count] is work space. */
static void join_splits(Factors *factors, TrainedRow *rows, int row_count) {
    for (int i = 0; i < row_count; i++) {
        int first = 0;
        while (strcmp(rows[first].network, rows[i].network) != 0) first++;
        if (first == i) factors->rows[factors->count++].row = rows[i];
    }
    qsort(rows, (size_t)row_count, sizeof *rows, row_order);
    for (int i = 0; i < factors->count; i++) {
        FactorRow *row = &factors->rows[i];
        int begin = 0, end, known;
        while (strcmp(rows[begin].network, row->row.network) != 0) begin++;
        for (end = begin; end < row_count && strcmp(rows[end].network, row->row.network) == 0;) end++;
        for (known = begin; known < end && !isnan(rows[known].ratio);) known++;
        row->least = known > begin ? rows[begin].ratio : NAN;
        row->most = known > begin ? rows[known - 1].ratio : NAN;
        row->row.ratio =
            known > begin ? (rows[(begin + known - 1) / 2].ratio + rows[(begin + known) / 2].ratio) / 2 : NAN;
    }
}

/* Groups the rows, and divides the groups so that the higher half is as low as possible. */
static void place_rows(Factors *factors) {
    FactorRow *to = factors->rows;
    const int count = factors->count;
    for (int i = 1; i < count; i++) {
        int at = i; /* behind the last of its factor, if there is one */
        while (at > 0 && !same_factor(&to[at - 1], &to[i])) at--;
        if (at == 0) continue;
        const FactorRow moved = to[i];
        memmove(&to[at + 1], &to[at], (size_t)(i - at) * sizeof *to);
        to[at] = moved;
    }
    int *middle = &factors->begin[1];
    *middle = factors->begin[HALVES] = count;
    factors->span = span_of(to, 0, count);
    for (int i = 1; i < count; i++) {
        if (same_factor(&to[i], &to[i - 1])) continue;
        const double higher = fmax(span_of(to, 0, i), span_of(to, i, count));
        if (higher >= factors->span) continue;
        factors->span = higher;
        *middle = i;
    }
    for (int i = 0; i < count; i++)
        factors->places[i] = i == 0 || i == *middle
                                 ? 0.65
                                 : factors->places[i - 1] + 1 + (same_factor(&to[i], &to[i - 1]) ? 0 : group_gap);
}

/* Two points of each row: of its guide, and of its range. */
static bool factors_point(const void *of, int half, int series, int i, PlotPoint *out) {
    const Factors *factors = of;
    const int index = series >= RANGES ? i / 2 : i;
    if (series == FACTORS_CONSTANT) return plot_upright(out, i, 1);
    if (index < factors->begin[half] || index >= factors->begin[half + 1]) return false;
    const FactorRow *row = &factors->rows[index];
    *out = (PlotPoint){row->row.ratio, factors->places[index], index};
    if (series == FACTORS_GUIDES) out->x = i % 2 == 0 ? -INFINITY : INFINITY;
    if (series == RANGES) out->x = i % 2 == 0 ? row->least : row->most;
    return series >= RANGES ? !isnan(row->row.ratio) : row->row.target == series;
}

static bool draw_factors(const Factors *factors, PlotPage *page, const char *path, Error *error) {
    static const char *const names[PAIR_TARGETS] = {"target pair", "target net", "target impulse", "target points"};
    /* mm */
    const double row_height = 3.3, half_width = FIGURE_PAGE_WIDTH / HALVES, left = 36, width = 39, numbers_right = 85,
                 bottom = 17.5, top = 6, points = 6.5;
    const double height = bottom + factors->span * row_height + top;
    PlotTicks none = {0};
    PlotRange range = {0.1, 1};
    for (int i = 0; i < factors->count; i++) {
        plot_range_include(&range, factors->rows[i].least);
        plot_range_include(&range, factors->rows[i].most);
    }
    PlotPanel panels[HALVES];
    const PlotGrid grid = {FIGURE_PAGE_WIDTH,        height, left, half_width - left - width, bottom, top, HALVES, 1,
                           .gap = half_width - width};
    for (int half = 0; half < HALVES; half++) {
        panels[half] =
            (PlotPanel){.box = plot_grid_box(&grid, half),
                        .x = plot_range_axis(range, 1e-4, 100, false, "Test error / that of predicting the mean"),
                        .y = plot_linear_axis(factors->span, 0, NULL)};
        if (factors->begin[half] == factors->begin[half + 1]) panels[half].box.width = 0;
        panels[half].y.ticks = &none;
    }
    PlotLook looks[FACTORS_SERIES] = {[RANGES] = {"range over the splits", {.colour = PLOT_GREY}, .line = 2.5},
                                      [FACTORS_CONSTANT] = plot_look_dashed("predicting the mean"),
                                      [FACTORS_GUIDES] = plot_look_guide()};
    for (int i = 0; i < PAIR_TARGETS; i++) looks[i] = plot_look_marks(i, names[i]);
    const PlotSpec spec = {
        .width = FIGURE_PAGE_WIDTH,
        .height = height,
        .panels = panels,
        .looks = looks,
        .panel_count = HALVES,
        .series = FACTORS_SERIES,
        .rows = 2 * factors->count,
        .point = factors_point,
        .of = factors,
        .legend_columns = 3,
        .legend_left = left,
        .legend_top = 6,
        .caption =
            "Test error of every network over that of the constant predictor (dashed: 1), by the factor in which "
            "it differs from the baseline: median over splits of the launches, and range. Errors are means of squares, "
            "each output in its range over the training rows. On the right: the number of parameters."};
    if (!plot_draw(page, &spec, path, error)) return false;
    /* Left of the plot the factor, right of it the number of parameters. */
    for (int half = 0; half < HALVES; half++) {
        const double from = half * half_width;
        if (factors->begin[half] < factors->begin[half + 1])
            plot_text(&page->sketch, (Point){from + numbers_right, page->sketch.height - top / 2}, TEXT_RIGHT, points,
                      "parameters");
        for (int i = factors->begin[half]; i < factors->begin[half + 1]; i++) {
            const TrainedRow *row = &factors->rows[i].row;
            const double y = bottom + (factors->span - factors->places[i]) * row_height;
            const bool alone = row->value[0] == '\0' || strcmp(row->factor, row->value) == 0;
            char text[2 * CSV_NAME_SIZE + 4];
            snprintf(text, sizeof text, "%s%s%s", row->factor, alone ? "" : " = ", alone ? "" : row->value);
            plot_text(&page->sketch, (Point){from + left - 1.5, y}, TEXT_RIGHT, text_points(text, points, left - 3),
                      text);
            if (isnan(row->ratio))
                plot_text(&page->sketch, (Point){from + left + 1, y}, TEXT_LEFT, points, "no result");
            snprintf(text, sizeof text, "%.0f", row->parameters);
            if (!isnan(row->parameters))
                plot_text(&page->sketch, (Point){from + numbers_right, y}, TEXT_RIGHT, points, text);
        }
    }
    return true;
}

bool plot_factors(const CsvTable *table, PlotPage *page, Error *error) {
    const size_t count = (size_t)table->count;
    Factors factors = {
        .rows = malloc(count * sizeof *factors.rows), .places = malloc(count * sizeof *factors.places), .count = 0};
    bool drawn = factors.rows != NULL && factors.places != NULL;
    if (drawn) {
        join_splits(&factors, table->rows, table->count);
        place_rows(&factors);
        drawn = draw_factors(&factors, page, table->csv.path, error);
    } else {
        error_memory(error, table->csv.path);
    }
    free(factors.rows);
    free(factors.places);
    return drawn;
}

/* One column wide: the error from scratch beside that after training on smaller scenes. */

enum { STARTS = 2, TRANSFER_CONSTANT = STARTS, TRANSFER_SERIES };

static bool transfer_point(const void *of, int panel, int series, int i, PlotPoint *out) {
    const TransferRow *row = (const TransferRow *)of + i;
    (void)panel;
    *out = (PlotPoint){row->launches, series == TRANSFER_CONSTANT ? row->constant : row->error, row->seed};
    return series == TRANSFER_CONSTANT || row->transfer == series;
}

bool plot_transfer(const CsvTable *table, PlotPage *page, Error *error) {
    static const char *const names[STARTS] = {"from scratch", "after single and stack"};
    const PlotGrid grid = {FIGURE_COLUMN_WIDTH, 64, 13, 2, 17.8, 3, 1, 1, 0, 0};
    const TransferRow *rows = table->rows;
    double least = PAPER_MAX_LAUNCHES, most = 1, highest = 1e-6;
    for (int i = 0; i < table->count; i++) {
        least = fmin(least, rows[i].launches);
        most = fmax(most, rows[i].launches);
        highest = fmax(highest, fmax(rows[i].error, rows[i].constant)); /* of a number and NAN, the number */
    }
    const double margin = most > 4 * least ? 1.3 : 2;
    PlotPanel panel = {.box = plot_grid_box(&grid, 0),
                       .x = plot_linear_axis(least / margin, most * margin, "Launches of the pyramid"),
                       .y = plot_linear_axis(0, highest * 1.08, "RMS velocity error (m/s)")};
    panel.x.scale = PLOT_DOUBLING;
    PlotLook looks[TRANSFER_SERIES] = {plot_look(0, names[0]), plot_look(1, names[1]),
                                       plot_look_dashed("predicting the mean")};
    for (int i = 0; i < TRANSFER_SERIES; i++) {
        looks[i].medians = true;
        looks[i].seeds = i < STARTS;
    }
    const PlotSpec spec = {
        .width = grid.width,
        .height = grid.height,
        .panels = &panel,
        .looks = looks,
        .panel_count = 1,
        .series = TRANSFER_SERIES,
        .rows = table->count,
        .point = transfer_point,
        .of = rows,
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

typedef struct Loop {
    const ClosedLoopRow *rows;
    int count, lines;
    int line[PAPER_MAX_LOOPS]; /* of each row, from the top, from 0 */
} Loop;

static double value_of(const ClosedLoopRow *row, int panel) {
    return panel == COSTS ? row->us_step / row->us_step_engine : row->frames_until_apart;
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

bool plot_closed_loop(const CsvTable *table, PlotPage *page, Error *error) {
    static const char *const scenes[PAPER_SCENES] = {"single", "stack", "pyramid", "pyramid, settled"};
    /* mm */
    const double row_height = 6, left = 36, frames_width = 76, gap = 6, right = 3, bottom = 15, top = 6;
    Loop loop = {.rows = table->rows, .count = table->count};
    PlotTicks none = {0};
    PlotRange costs = {1, 1};
    for (int i = 0; i < loop.count; i++) {
        int first = 0;
        while (strcmp(loop.rows[first].network, loop.rows[i].network) != 0) first++;
        loop.line[i] = first < i ? loop.line[first] : loop.lines++;
        plot_range_include(&costs, value_of(&loop.rows[i], COSTS));
    }
    const double height = bottom + loop.lines * row_height + top, second = left + frames_width + gap;
    PlotPanel panels[PANELS] = {{.box = {left, bottom, frames_width, height - bottom - top},
                                 .title = "In place of the solver",
                                 .x = plot_range_axis((PlotRange){1, CLOSED_LOOP_FRAMES}, 1, CLOSED_LOOP_FRAMES, false,
                                                      "Frames until divergence by 0.1 m (600: never)")},
                                {.box = {second, bottom, FIGURE_PAGE_WIDTH - second - right, height - bottom - top},
                                 .title = "Cost",
                                 .x = plot_range_axis(costs, 1e-3, 1e4, false, "Step time / the engine's")}};
    for (int i = 0; i < PANELS; i++) {
        panels[i].y = plot_linear_axis(loop.lines - 0.5, -0.5, NULL);
        panels[i].y.ticks = &none;
    }
    PlotLook looks[LOOP_SERIES] = {[LOOP_GUIDES] = plot_look_guide(), [DASHED] = plot_look_dashed(NULL)};
    for (int i = 0; i < PAPER_SCENES; i++) looks[i] = plot_look_marks(i, scenes[i]);
    const PlotSpec spec = {
        .width = FIGURE_PAGE_WIDTH,
        .height = height,
        .panels = panels,
        .looks = looks,
        .panel_count = PANELS,
        .series = LOOP_SERIES,
        .rows = 2 * loop.count,
        .point = loop_point,
        .of = &loop,
        .legend_columns = PAPER_SCENES,
        .legend_left = left,
        .legend_top = 2.7,
        .caption =
            "Networks and solvers in closed loop. Left: frames until a body is 0.1 m from its place in the converged "
            "run (600, dashed: never), a mark for each split on which a network was trained. Right: time of a step "
            "over that of the engine with its own solver (dashed: "
            "equal)."};
    if (!plot_draw(page, &spec, table->csv.path, error)) return false;
    for (int i = 0, next = 0; i < loop.count; i++) {
        if (loop.line[i] != next) continue;
        const char *name = loop.rows[i].network;
        plot_text(&page->sketch, (Point){left - 1.5, bottom + (loop.lines - next++ - 0.5) * row_height}, TEXT_RIGHT,
                  text_points(name, 7, left - 3), name);
    }
    return true;
}
