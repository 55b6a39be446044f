/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_borders.h"

#include "stability/border_axis.h"
#include "stability/border_marks.h"

#include <math.h>

/* mm */
static const double left = 33, right = 2, gap = 3.5, title_room = 5.5, axis_room = 8.8, legend_left = 20,
                    most_page = 235, most_row = 3.4, least_row = 2.5, sample = 5.5, name_gap = 1.3;

enum { LEGEND_COLUMNS = 5 };

typedef struct Borders {
    const BorderTable *table;
    Sketch *sketch;
    int study_count, method_count;
    int studies[BORDERS_MAX_STUDIES], methods[BORDERS_MAX_METHODS]; /* first row of each */
    int columns, rows, legend_rows;
    double row_height; /* mm */
    PlotGrid grid;
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
    int items = BORDER_SIGNS;
    for (int look = 0; look < VERDICT_LOOKS; look++) items += borders->used[look];
    borders->legend_rows = (items + LEGEND_COLUMNS - 1) / LEGEND_COLUMNS;
    borders->columns = borders->study_count <= 2 ? borders->study_count : borders->study_count <= 6 ? 3 : 4;
    borders->rows = (borders->study_count + borders->columns - 1) / borders->columns;
    const double legend = LEGEND_ROW * borders->legend_rows + 2, around = title_room + axis_room;
    const double room = (most_page - legend) / borders->rows - around;
    borders->row_height = fmin(fmax(room / borders->method_count, least_row), most_row);
    borders->grid =
        (PlotGrid){.width = FIGURE_PAGE_WIDTH,
                   .height = legend + borders->rows * (around + borders->row_height * borders->method_count),
                   .left = left,
                   .right = right,
                   .bottom = legend + axis_room,
                   .top = title_room,
                   .columns = borders->columns,
                   .rows = borders->rows,
                   .gap = gap,
                   .row_gap = around};
}

/* A guide for each method, and in the first column its name. */
static void draw_rows(const Borders *borders, const PlotPanel *panel, bool named) {
    const Pen guide = pen_line(0xE2E2E2, 0.6, NULL);
    const double points = 7;
    for (int method = 0; method < borders->method_count; method++) {
        const BorderRow *row = &borders->table->rows[borders->methods[method]];
        const double y = plot_axis_place(&panel->y, method);
        char text[STABILITY_TEXT_SIZE];
        sketch_line(borders->sketch, (Point){panel->x.from, y}, (Point){panel->x.to, y}, &guide);
        if (!named) continue;
        stability_method_text(text, points, left - 3, row->method, row->setting);
        plot_text(borders->sketch, (Point){left - 1.5, y}, TEXT_RIGHT, points, text);
    }
}

static void draw_panel(const Borders *borders, int study) {
    static const PlotTicks none;
    const BorderRow *first = &borders->table->rows[borders->studies[study]];
    PlotPanel panel = {.box = plot_grid_box(&borders->grid, study)};
    BorderAxis axis = border_axis(borders->table, borders->studies[study], panel.box.width);
    char title[STABILITY_TEXT_SIZE];
    stability_axis_text(title, first->study, "");
    text_fit(title, sizeof title, 8, panel.box.width);
    panel.title = title;
    panel.x = axis.axis;
    panel.x.label = axis.label;
    panel.y = plot_linear_axis(borders->method_count - 0.5, -0.5, NULL);
    panel.y.ticks = &none;
    plot_panel_place(&panel);
    draw_rows(borders, &panel, study % borders->columns == 0);
    border_marks_draw(&(BorderRows){borders->table, borders->sketch, first, &panel, axis.falling, borders->methods,
                                    borders->method_count});
    plot_panel_draw(borders->sketch, &panel);
}

static void draw_samples(const Borders *borders, const LegendPlace *place, int first) {
    static const char *const names[BORDER_SIGNS] = {"holds", "holds throughout", "never holds"};
    for (int i = 0; i < BORDER_SIGNS; i++) {
        const Point at = {place->left + place->width * ((first + i) % place->columns),
                          place->top - LEGEND_ROW * ((first + i) / place->columns)};
        border_sample_draw(borders->sketch, i, at, sample);
        plot_text(borders->sketch, (Point){at.x + sample + name_gap, at.y}, TEXT_LEFT, LEGEND_POINTS, names[i]);
    }
}

static void draw_legend(const Borders *borders) {
    LegendPlace place = {legend_left, LEGEND_ROW * (borders->legend_rows - 0.5) + 0.5,
                         (FIGURE_PAGE_WIDTH - legend_left) / LEGEND_COLUMNS, LEGEND_COLUMNS};
    draw_samples(borders, &place, verdict_draw_legend(borders->sketch, borders->used, &place));
}

bool stability_borders_write(const BorderTable *table, PlotPage *page, Error *error) {
    static const char caption[] =
        "How far each method holds, on each study's own axis. Bars cover the values that hold. Tiles show how a method "
        "fails: at the first value that fails or, where tiny shifts of the start decide beyond the bar, at the far "
        "end. "
        "Arrow: holds over the whole range; cross: never holds; no mark: not in the study.\n";
    Borders borders = {.table = table, .sketch = &page->sketch};
    if (!gather(&borders, error)) return false;
    lay_out(&borders);
    sketch_begin(&page->sketch, borders.grid.width, borders.grid.height);
    for (int study = 0; study < borders.study_count; study++) draw_panel(&borders, study);
    draw_legend(&borders);
    snprintf(page->caption, sizeof page->caption, "%s", caption);
    return true;
}
