/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A dot plot in two columns: one line a network, the networks of a factor together. */
#include "chart/csv_columns.h"
#include "chart/figure_axis.h"
#include "paper/figures/figures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct Row {
    char factor[CSV_NAME_SIZE], value[CSV_NAME_SIZE];
    int target;
    double parameters, ratio;
    int group; /* of rows with the same factor, from 0 */
} Row;

static const CsvColumn columns[] = {
    {"factor", CSV_NAME, offsetof(Row, factor), NULL, 0, 0},
    {"value", CSV_NAME, offsetof(Row, value), NULL, 0, 0},
    {"target", CSV_WORD, offsetof(Row, target), figure_targets, 0, 0},
    {"parameters", CSV_MAYBE, offsetof(Row, parameters), NULL, 0, 1e9},
    {"ratio", CSV_MAYBE, offsetof(Row, ratio), NULL, 0, 1e30},
};

enum { MAX_ROWS = 200, HALVES = 2, LABEL_MAX = 30 };

/* What the best network of a target is to reach; 0: no aim. */
static const double aims[FIGURE_TARGETS] = {0.4, 0.4, 0.1, 0};

/* mm */
static const double row_height = 3.3, half_width = FIGURE_PAGE_WIDTH / HALVES, plot_left = 36, plot_width = 39,
                    numbers_right = 85, bottom = 17.5, top = 6, legend_top = 6, aim_width = 0.6;

/* In rows. */
static const double group_gap = 0.7, aim_height = 0.86;

static const double least_ratio = 1e-4, most_ratio = 100;

static int compare_rows(const void *first, const void *second) {
    const Row *a = first, *b = second;
    return a->group - b->group;
}

/* Gives each row its factor's place among the factors, and in it a place of its own: qsort() may turn equals. */
static void group_rows(Row *rows, int count) {
    for (int i = 0; i < count; i++) {
        int first = 0;
        while (strcmp(rows[first].factor, rows[i].factor) != 0) first++;
        rows[i].group = first * MAX_ROWS + i;
    }
    qsort(rows, (size_t)count, sizeof *rows, compare_rows);
    for (int i = 0; i < count; i++) rows[i].group /= MAX_ROWS;
}

/* Height of rows [begin, end), in rows. */
static double span_of(const Row *rows, int begin, int end) {
    double span = 0.3 + (end - begin);
    for (int i = begin + 1; i < end; i++) span += rows[i].group != rows[i - 1].group ? group_gap : 0;
    return span;
}

/* The second half begins with a group, where both are about as high. */
static int split(const Row *rows, int count, double *span) {
    int best = count;
    *span = span_of(rows, 0, count);
    for (int i = 1; i < count; i++) {
        if (rows[i].group == rows[i - 1].group) continue;
        double higher = fmax(span_of(rows, 0, i), span_of(rows, i, count));
        if (higher >= *span) continue;
        *span = higher;
        best = i;
    }
    return best;
}

typedef struct Factors {
    FigurePage *page;
    const Row *rows;
    int begin, end; /* of the half */
    FigureAxis x;
    double span; /* of the higher half, in rows */
} Factors;

static FigureLook guide_look(void) {
    return (FigureLook){"", {.colour = "#C8C8C8", .ink = "#C8C8C8", .dashes = "solid"}, 0.6, false, 0, false};
}

static FigureLook aim_look(void) {
    return (FigureLook){
        "aim for the best", {.colour = "black", .ink = "black", .dashes = "solid"}, 0, false, aim_width, true};
}

/* Places of rows, downwards from 0. */
static double next_place(const Factors *factors, int i, double place) {
    if (i == factors->begin) return 0.65;
    return place + 1 + (factors->rows[i].group != factors->rows[i - 1].group ? group_gap : 0);
}

static void put_guides(const Factors *factors) {
    FigureLook guide = guide_look(), constant = figure_dashed("");
    double place = 0;
    figure_series(factors->page);
    for (int i = factors->begin; i < factors->end; i++) {
        place = next_place(factors, i, place);
        if (isnan(factors->rows[i].ratio)) continue;
        figure_segment(factors->page, factors->x.log.low, place, factors->x.log.high, place);
    }
    figure_draw(factors->page, &guide);
    figure_series(factors->page);
    figure_segment(factors->page, 1, 0, 1, factors->span);
    figure_draw(factors->page, &constant);
}

static void put_dots(const Factors *factors, int target) {
    FigureLook dot = figure_marks(figure_look(target, ""));
    double place = 0;
    figure_series(factors->page);
    for (int i = factors->begin; i < factors->end; i++) {
        const Row *row = &factors->rows[i];
        place = next_place(factors, i, place);
        if (row->target == target)
            figure_point(factors->page, figure_on(factors->page, &factors->x, row->ratio), place);
    }
    figure_draw(factors->page, &dot);
}

/* Higher than a dot, so that they show behind one. */
static void put_aims(const Factors *factors) {
    FigureLook look = aim_look();
    double half = pow(factors->x.log.high / factors->x.log.low, aim_width / 2 / plot_width), place = 0;
    figure_series(factors->page);
    for (int i = factors->begin; i < factors->end; i++) {
        const Row *row = &factors->rows[i];
        place = next_place(factors, i, place);
        double aim = aims[row->target];
        if (strcmp(row->factor, "best") == 0 && aim > 0)
            figure_bar(factors->page, aim / half, place - aim_height / 2, aim * half, place + aim_height / 2);
    }
    figure_draw(factors->page, &look);
}

static void put_names(const Factors *factors, double left) {
    double place = 0;
    for (int i = factors->begin; i < factors->end; i++) {
        const Row *row = &factors->rows[i];
        place = next_place(factors, i, place);
        double y = bottom + (factors->span - place) * row_height;
        char text[2 * CSV_NAME_SIZE + 4];
        bool alone = row->value[0] == '\0' || strcmp(row->factor, row->value) == 0;
        int length = snprintf(text, sizeof text, "%s%s%s", row->factor, alone ? "" : " = ", alone ? "" : row->value);
        if (length > LABEL_MAX) strcpy(text + LABEL_MAX - 3, "...");
        figure_text(factors->page, left + plot_left - 1.5, y, "right", 6.5, text);
        if (isnan(row->ratio)) figure_text(factors->page, left + plot_left + 1, y, "left", 6.5, "no result");
        snprintf(text, sizeof text, "%.0f", row->parameters);
        if (!isnan(row->parameters)) figure_text(factors->page, left + numbers_right, y, "right", 6.5, text);
    }
}

static void put_half(Factors *factors, int half) {
    FigurePage *page = factors->page;
    double left = half * half_width;
    figure_panel(page, (FigureBox){left + plot_left, bottom, plot_width, factors->span * row_height}, "");
    figure_log(page, 'x', &factors->x, "Test error / that of predicting the mean");
    figure_linear(page, 'y', factors->span, 0, "", NULL);
    figure_text(page, left + numbers_right, page->height - top / 2, "right", 6.5, "parameters");
    put_names(factors, left);
    put_guides(factors);
    put_aims(factors);
    for (int target = 0; target < FIGURE_TARGETS; target++) put_dots(factors, target);
    figure_panel_end(page);
}

static void put_legend(FigurePage *page, const Row *rows, int count) {
    static const char *const names[FIGURE_TARGETS] = {"target pair", "target net", "target impulse", "target points"};
    FigureLook looks[FIGURE_TARGETS + 2];
    int entries = 0;
    for (int target = 0; target < FIGURE_TARGETS; target++) {
        bool used = false;
        for (int i = 0; i < count; i++) used |= rows[i].target == target;
        if (used) looks[entries++] = figure_marks(figure_look(target, names[target]));
    }
    looks[entries++] = aim_look();
    looks[entries++] = figure_dashed("predicting the mean");
    figure_legend(page, looks, entries, (entries + 1) / 2, plot_left, legend_top);
}

bool figure_factors(const char *folder, FigurePage *page, Error *error) {
    int count;
    Row *rows = csv_columns_read(folder, "networks", columns, sizeof columns / sizeof *columns, sizeof *rows, MAX_ROWS,
                                 &count, error);
    if (rows == NULL) return false;
    group_rows(rows, count);
    FigureRange range = {aims[2], 1};
    for (int i = 0; i < count; i++) figure_widen(&range, rows[i].ratio);
    Factors factors = {page, rows, 0, 0, figure_axis(range, least_ratio, most_ratio, false), 0};
    int middle = split(rows, count, &factors.span);
    figure_begin(page, FIGURE_PAGE_WIDTH, bottom + factors.span * row_height + top);
    for (int half = 0; half < HALVES; half++) {
        factors.begin = half == 0 ? 0 : middle;
        factors.end = half == 0 ? middle : count;
        if (factors.begin < factors.end) put_half(&factors, half);
    }
    put_legend(page, rows, count);
    fprintf(
        page->caption,
        "Test error of every network, as a share of that of always predicting the mean (dashed: 1), by what differs "
        "from the baseline; on the right the number of parameters. Upright bars: the aims for the best networks, "
        "0.4 for the targets pair and net and 0.1 for impulse.");
    figure_end(page);
    free(rows);
    return true;
}
