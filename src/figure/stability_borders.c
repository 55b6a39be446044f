/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/stability_borders.h"

#include "figure/border_axis.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

/* mm */
static const double left = 33, right = 2, gap = 3.5, title_room = 5.5, axis_room = 8.8, most_page = 235, most_row = 3.4,
                    least_row = 2.5, bar_height = 1.2, half_tile = 1.15, sign = 0.75, sample = 5.5, name_gap = 1.3,
                    letter = 1.35, title_letter = 1.6;

#define BAR_COLOUR "#A3CBE5"
#define GUIDE_COLOUR "#E2E2E2"

enum { LEGEND_COLUMNS = 5, SIGNS = 3 };

typedef struct Borders {
    const BorderTable *table;
    FigurePage *page;
    int study_count, method_count;
    int studies[BORDERS_MAX_STUDIES], methods[BORDERS_MAX_METHODS]; /* the first row of each */
    int columns, rows, legend_rows;
    double width, row_height, bottom; /* mm: of a panel; of a method; where the lowest panel begins */
    bool used[VERDICT_LOOKS];
} Borders;

static bool same_method(const BorderRow *a, const BorderRow *b) {
    return strcmp(a->method, b->method) == 0 && strcmp(a->setting, b->setting) == 0;
}

static bool same_study(const BorderRow *a, const BorderRow *b) { return strcmp(a->study, b->study) == 0; }

/* Adds row i where it is the first of its kind. False where there is no room. */
static bool add_first(const BorderTable *table, int i, bool (*same)(const BorderRow *, const BorderRow *), int *firsts,
                      int *count, int most) {
    for (int k = 0; k < *count; k++)
        if (same(&table->rows[firsts[k]], &table->rows[i])) return true;
    if (*count == most) return false;
    firsts[(*count)++] = i;
    return true;
}

static bool gather(Borders *borders, Error *error) {
    const BorderTable *table = borders->table;
    for (int i = 0; i < table->count; i++) {
        if (!add_first(table, i, same_study, borders->studies, &borders->study_count, BORDERS_MAX_STUDIES))
            return stability_row_error(table->path, i, error, "more than %d studies: too many for a figure",
                                       BORDERS_MAX_STUDIES);
        if (!add_first(table, i, same_method, borders->methods, &borders->method_count, BORDERS_MAX_METHODS))
            return stability_row_error(table->path, i, error, "more than %d methods: too many for a figure",
                                       BORDERS_MAX_METHODS);
        if (!verdict_holds((Verdict)table->rows[i].verdict)) borders->used[table->rows[i].verdict] = true;
    }
    return true;
}

/* On a page as high as a paper's where that leaves room enough for a row. */
static void lay_out(Borders *borders) {
    FigurePage *page = borders->page;
    int items = SIGNS;
    for (int look = 0; look < VERDICT_LOOKS; look++) items += borders->used[look];
    borders->legend_rows = (items + LEGEND_COLUMNS - 1) / LEGEND_COLUMNS;
    borders->columns = borders->study_count <= 2 ? borders->study_count : borders->study_count <= 6 ? 3 : 4;
    borders->rows = (borders->study_count + borders->columns - 1) / borders->columns;
    borders->width = (FIGURE_PAGE_WIDTH - left - right - gap * (borders->columns - 1)) / borders->columns;
    double legend = FIGURE_LEGEND_ROW * borders->legend_rows + 1, around = title_room + axis_room;
    double room = (most_page - legend) / borders->rows - around;
    borders->row_height = fmin(fmax(room / borders->method_count, least_row), most_row);
    borders->bottom = legend + axis_room;
    page->width = FIGURE_PAGE_WIDTH;
    page->height = legend + borders->rows * (around + borders->row_height * borders->method_count);
}

static void put_guides(const Borders *borders) {
    const FigureLook look = {"", {.colour = GUIDE_COLOUR, .dashes = "solid"}, 0.6, false, 0, false};
    figure_series(borders->page);
    for (int method = 0; method < borders->method_count; method++)
        figure_segment(borders->page, 0, method, borders->width, method);
    figure_draw(borders->page, &look);
}

/* Where the bar of a border ends that is held on its low side or not: at the next border of the same method that way, or
   at the panel's edge. */
static double far_end(const Borders *borders, const BorderRow *row, const BorderAxis *axis, bool low) {
    double end = low ? 0 : axis->width, from = border_axis_place(axis, row->holds_at);
    for (int i = 0; i < borders->table->count; i++) {
        const BorderRow *other = &borders->table->rows[i];
        if (other == row || !same_study(other, row) || !same_method(other, row) || isnan(other->holds_at)) continue;
        double place = border_axis_place(axis, other->holds_at);
        if (low ? place <= from && place > end : place >= from && place < end) end = place;
    }
    return end;
}

static void put_bar(const Borders *borders, const BorderRow *row, const BorderAxis *axis, int method) {
    if (isnan(row->holds_at)) return;
    bool whole = isnan(row->fails_at), low = row->holds_at < row->fails_at;
    double half = bar_height / 2 / borders->row_height;
    double from = whole ? 0 : far_end(borders, row, axis, low);
    double to = whole ? axis->width : border_axis_place(axis, row->holds_at);
    figure_bar(borders->page, fmin(from, to), method - half, fmax(from, to), method + half);
}

/* The head of an arrow with its tip at x; or a cross. `up` is the units of the panel in a mm. */
static void put_head(FigurePage *page, double x, double y, double up, bool to_the_left) {
    double back = to_the_left ? x + 1.5 * sign : x - 1.5 * sign;
    figure_point(page, back, y + sign * up);
    figure_point(page, x, y);
    figure_point(page, back, y - sign * up);
    figure_gap(page);
}

static void put_cross(FigurePage *page, double x, double y, double up) {
    figure_segment(page, x - sign, y - sign * up, x + sign, y + sign * up);
    figure_segment(page, x - sign, y + sign * up, x + sign, y - sign * up);
}

static void put_sign(const Borders *borders, const BorderRow *row, const BorderAxis *axis, int method) {
    double up = 1 / borders->row_height, easy = axis->falling ? axis->width - 2 * sign : 2 * sign;
    if (isnan(row->fails_at) && !isnan(row->holds_at))
        put_head(borders->page, axis->falling ? sign : axis->width - sign, method, up, axis->falling);
    if (isnan(row->holds_at) && !isnan(row->fails_at)) put_cross(borders->page, easy, method, up);
}

static Tile tile_of(const BorderRow *row, const BorderAxis *axis, int method) {
    double easy = axis->falling ? axis->width - 2 * sign : 2 * sign;
    return (Tile){isnan(row->fails_at) ? easy : border_axis_place(axis, row->fails_at), method, row->verdict};
}

static int method_of(const Borders *borders, const BorderRow *row) {
    int i = 0;
    while (!same_method(&borders->table->rows[borders->methods[i]], row)) i++;
    return i;
}

static FigureLook bar_look(void) { return (FigureLook){"", {.colour = BAR_COLOUR}, 0, false, 1, false}; }

static FigureLook sign_look(void) {
    return (FigureLook){"", {.colour = "black", .dashes = "solid"}, 1.6, false, 0, false};
}

/* Bars, then tiles, then arrows and crosses. */
static void put_rows(const Borders *borders, const BorderRow *study, const BorderAxis *axis) {
    const FigureLook bars = bar_look(), signs = sign_look();
    Tile tiles[STABILITY_MAX_BORDERS];
    int count = 0;
    for (int part = 0; part < 2; part++) {
        figure_series(borders->page);
        for (int i = 0; i < borders->table->count; i++) {
            const BorderRow *row = &borders->table->rows[i];
            if (!same_study(row, study)) continue;
            int method = method_of(borders, row);
            (part == 0 ? put_bar : put_sign)(borders, row, axis, method);
            bool holds = isnan(row->fails_at) && !isnan(row->holds_at);
            if (part == 0 && !holds) tiles[count++] = tile_of(row, axis, method);
        }
        figure_draw(borders->page, part == 0 ? &bars : &signs);
        if (part == 0) verdict_put_tiles(borders->page, tiles, count, (TileScale){1, borders->row_height, half_tile});
    }
}

static void put_names(const Borders *borders, double bottom) {
    for (int method = 0; method < borders->method_count; method++) {
        const BorderRow *row = &borders->table->rows[borders->methods[method]];
        char text[STABILITY_TEXT_SIZE];
        stability_method_text(text, row->method, row->setting);
        figure_cut(text, (size_t)((left - 1.5) / letter));
        figure_text(borders->page, left - 1.5, bottom + (borders->method_count - method - 0.5) * borders->row_height,
                    "right", 7, text);
    }
}

static void put_panel(const Borders *borders, int study) {
    const BorderRow *first = &borders->table->rows[borders->studies[study]];
    int column = study % borders->columns, row = study / borders->columns;
    double height = borders->row_height * borders->method_count;
    FigureBox box = {left + column * (borders->width + gap),
                     borders->bottom + (borders->rows - 1 - row) * (height + title_room + axis_room), borders->width,
                     height};
    char title[STABILITY_TEXT_SIZE];
    stability_axis_text(title, first->study, "");
    figure_cut(title, (size_t)(borders->width / title_letter));
    BorderAxis axis = border_axis(borders->table, borders->studies[study], borders->width);
    figure_panel(borders->page, box, title);
    border_axis_put(&axis, borders->page);
    figure_linear(borders->page, 'y', borders->method_count - 0.5, -0.5, "", NULL);
    if (column == 0) put_names(borders, box.bottom);
    put_guides(borders);
    put_rows(borders, first, &axis);
    figure_panel_end(borders->page);
}

static void put_samples(const Borders *borders, const LegendPlace *place, int first) {
    static const char *const names[SIGNS] = {"holds", "over the whole range", "never holds"};
    FigurePage *page = borders->page;
    const FigureLook bars = bar_look(), signs = sign_look();
    for (int i = 0; i < SIGNS; i++) {
        double x = place->left + place->width * ((first + i) % place->columns),
               y = place->top - FIGURE_LEGEND_ROW * ((first + i) / place->columns);
        figure_series(page);
        if (i < 2) figure_bar(page, x, y - bar_height / 2, x + sample, y + bar_height / 2);
        figure_draw(page, &bars);
        figure_series(page);
        if (i == 1) put_head(page, x + sample, y, 1, false);
        if (i == 2) put_cross(page, x + 2 * sign, y, 1);
        figure_draw(page, &signs);
        figure_text(page, x + (i == 2 ? 4 * sign : sample) + name_gap, y, "left", 7.5, names[i]);
    }
}

static void put_legend(const Borders *borders) {
    FigurePage *page = borders->page;
    LegendPlace place = {left, FIGURE_LEGEND_ROW * (borders->legend_rows - 0.5) + 0.5,
                         (page->width - left) / LEGEND_COLUMNS, LEGEND_COLUMNS};
    figure_page_panel(page);
    int next = verdict_put_legend(page, borders->used, &place);
    put_samples(borders, &place, next);
    figure_panel_end(page);
}

bool stability_borders_write(const BorderTable *table, FigurePage *page, Error *error) {
    Borders borders = {.table = table, .page = page};
    if (!gather(&borders, error)) return false;
    lay_out(&borders);
    figure_begin(page, page->width, page->height);
    for (int study = 0; study < borders.study_count; study++) put_panel(&borders, study);
    put_legend(&borders);
    fprintf(page->caption,
            "How far each method holds, on each study's own axis. Bars go over what holds; tiles stand at the first "
            "value that fails and tell how. An arrow: holds over the whole range that was looked at; a cross: never "
            "holds.");
    figure_end(page);
    return true;
}
