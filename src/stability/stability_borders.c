/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_borders.h"

#include "stability/border_axis.h"
#include "stability/border_marks.h"

#include <math.h>

/* mm */
static const double left = 33, right = 2, gap = 3.5, title_room = 5.5, axis_room = 8.8, legend_left = 20,
                    most_page = 235, most_row = 3.4, least_row = 2.5, sample = 5.5, name_gap = 1.3, letter = 1.35,
                    title_letter = 1.6;

#define GUIDE_COLOUR "#E2E2E2"

enum { LEGEND_COLUMNS = 5 };

typedef struct Borders {
    const BorderTable *table;
    GnuplotPage *page;
    int study_count, method_count;
    int studies[BORDERS_MAX_STUDIES], methods[BORDERS_MAX_METHODS]; /* first row of each */
    int columns, rows, legend_rows;
    double width, row_height, bottom; /* mm: panel width, row height, bottom of the lowest panel */
    bool used[VERDICT_LOOKS];
} Borders;

/* Adds row i if it is the first of its study or method. False if there are too many. */
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
        if (!add_first(table, i, border_same_study, borders->studies, &borders->study_count, BORDERS_MAX_STUDIES))
            return csv_table_error(&table->csv, i, 0, error, "more than %d studies: too many for a figure",
                                   BORDERS_MAX_STUDIES);
        if (!add_first(table, i, border_same_method, borders->methods, &borders->method_count, BORDERS_MAX_METHODS))
            return csv_table_error(&table->csv, i, 0, error, "more than %d methods: too many for a figure",
                                   BORDERS_MAX_METHODS);
        if (!verdict_holds((Verdict)table->rows[i].verdict)) borders->used[table->rows[i].verdict] = true;
    }
    return true;
}

/* Uses the height of a printed page if that gives rows of a readable height. */
static void lay_out(Borders *borders) {
    GnuplotPage *page = borders->page;
    int items = BORDER_SIGNS;
    for (int look = 0; look < VERDICT_LOOKS; look++) items += borders->used[look];
    borders->legend_rows = (items + LEGEND_COLUMNS - 1) / LEGEND_COLUMNS;
    borders->columns = borders->study_count <= 2 ? borders->study_count : borders->study_count <= 6 ? 3 : 4;
    borders->rows = (borders->study_count + borders->columns - 1) / borders->columns;
    borders->width = (FIGURE_PAGE_WIDTH - left - right - gap * (borders->columns - 1)) / borders->columns;
    double legend = GNUPLOT_LEGEND_ROW * borders->legend_rows + 2, around = title_room + axis_room;
    double room = (most_page - legend) / borders->rows - around;
    borders->row_height = fmin(fmax(room / borders->method_count, least_row), most_row);
    borders->bottom = legend + axis_room;
    page->width = FIGURE_PAGE_WIDTH;
    page->height = legend + borders->rows * (around + borders->row_height * borders->method_count);
}

static void draw_guides(const Borders *borders) {
    const GnuplotLook look = {"", {.colour = GUIDE_COLOUR, .dashes = "solid"}, 0.6, false, 0, false};
    gnuplot_series_begin(borders->page);
    for (int method = 0; method < borders->method_count; method++)
        gnuplot_segment(borders->page, 0, method, borders->width, method);
    gnuplot_series_end(borders->page, &look);
}

static void draw_names(const Borders *borders, double bottom) {
    for (int method = 0; method < borders->method_count; method++) {
        const BorderRow *row = &borders->table->rows[borders->methods[method]];
        char text[STABILITY_TEXT_SIZE];
        stability_method_text(text, (size_t)((left - 1.5) / letter), row->method, row->setting);
        gnuplot_text(borders->page, left - 1.5, bottom + (borders->method_count - method - 0.5) * borders->row_height,
                     "right", 7, text);
    }
}

static void draw_panel(const Borders *borders, int study) {
    const BorderRow *first = &borders->table->rows[borders->studies[study]];
    int column = study % borders->columns, row = study / borders->columns;
    double height = borders->row_height * borders->method_count;
    GnuplotBox box = {left + column * (borders->width + gap),
                      borders->bottom + (borders->rows - 1 - row) * (height + title_room + axis_room), borders->width,
                      height};
    char title[STABILITY_TEXT_SIZE];
    stability_axis_text(title, first->study, "");
    gnuplot_truncate(title, (size_t)(borders->width / title_letter));
    BorderAxis axis = border_axis(borders->table, borders->studies[study], borders->width);
    gnuplot_panel_begin(borders->page, box, title);
    border_axis_write(&axis, borders->page);
    gnuplot_linear_axis(borders->page, 'y', -0.5, borders->method_count - 0.5, "", NULL);
    if (column == 0) draw_names(borders, box.bottom);
    draw_guides(borders);
    border_marks_draw(&(BorderRows){borders->table, borders->page, first, &axis, borders->methods,
                                    borders->method_count, borders->row_height});
    gnuplot_panel_end(borders->page);
}

static void draw_samples(const Borders *borders, const LegendPlace *place, int first) {
    static const char *const names[BORDER_SIGNS] = {"holds", "holds throughout", "never holds"};
    GnuplotPage *page = borders->page;
    for (int i = 0; i < BORDER_SIGNS; i++) {
        double x = place->left + place->width * ((first + i) % place->columns),
               y = place->top - GNUPLOT_LEGEND_ROW * ((first + i) / place->columns);
        border_sample_draw(page, i, x, y, sample);
        gnuplot_text(page, x + sample + name_gap, y, "left", 7.5, names[i]);
    }
}

static void draw_legend(const Borders *borders) {
    GnuplotPage *page = borders->page;
    LegendPlace place = {legend_left, GNUPLOT_LEGEND_ROW * (borders->legend_rows - 0.5) + 0.5,
                         (page->width - legend_left) / LEGEND_COLUMNS, LEGEND_COLUMNS};
    gnuplot_page_panel_begin(page);
    int next = verdict_draw_legend(page, borders->used, &place);
    draw_samples(borders, &place, next);
    gnuplot_panel_end(page);
}

bool stability_borders_write(const BorderTable *table, GnuplotPage *page, Error *error) {
    Borders borders = {.table = table, .page = page};
    if (!gather(&borders, error)) return false;
    lay_out(&borders);
    gnuplot_page_begin(page, page->width, page->height);
    for (int study = 0; study < borders.study_count; study++) draw_panel(&borders, study);
    draw_legend(&borders);
    fprintf(page->caption,
            "How far each method holds, on each study's own axis. Bars cover the values that hold. Tiles show how a "
            "method fails: at the first value that fails or, where tiny shifts of the start decide beyond the bar, at "
            "the far end. Arrow: holds over the whole range; cross: never holds; no mark: not in the study.");
    gnuplot_page_end(page);
    return true;
}
