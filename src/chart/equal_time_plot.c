/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/equal_time_plot.h"

#include "chart/equal_time_grid.h"
#include "chart/gnuplot.h"
#include "chart/gnuplot_page.h"
#include "common/file.h"
#include "common/memory_stream.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* mm */
static const double cell_height = 6.2, cell_least = 9.5, cell_most = 13, gap = 1.2, letter = 1.55, name_slope = 1.15,
                    foot = 16, note_height = 3.5, bar_height = 2.6, bar_width = 62, note_width = 76;
static const double degrees = 40;
static const double strongest = 1000; /* ratio, and its inverse, with the full colour */

typedef struct Layout {
    const EqualTimeGrid *grid;
    GnuplotPage *page;
    double left, top, cell; /* mm: left of the first cell, top of the first row, width of a cell */
    double foot;            /* mm: height of all below the rows */
} Layout;

static double longest(const char (*names)[CHART_TEXT_SIZE], int count) {
    size_t most = 0;
    for (int i = 0; i < count; i++) most = strlen(names[i]) > most ? strlen(names[i]) : most;
    return letter * (double)most;
}

static int gaps_before(const EqualTimeGrid *grid, int column) {
    int gaps = 0;
    for (int i = 1; i <= column; i++) gaps += !grid->joined[i];
    return gaps;
}

static double column_x(const Layout *layout, int column) {
    return layout->left + column * layout->cell + gap * gaps_before(layout->grid, column);
}

static Layout lay_out(const EqualTimeGrid *grid, GnuplotPage *page) {
    Layout layout = {.grid = grid, .page = page, .left = longest(grid->scenes, grid->rows) + 4};
    const double gaps = gap * gaps_before(grid, grid->columns - 1);
    const double turned = degrees * acos(-1) / 180, last = letter * (double)strlen(grid->methods[grid->columns - 1]);
    const double right = fmax(last * cos(turned) - cell_least / 2 + 2, 3);
    const double room = (FIGURE_PAGE_WIDTH - layout.left - right - gaps) / grid->columns;
    layout.cell = fmin(fmax(room, cell_least), cell_most);
    page->width = fmax(layout.left + grid->columns * layout.cell + gaps + right, layout.left + bar_width + note_width);
    layout.foot = foot + (grid->times[0] != '\0' ? note_height : 0);
    layout.top = layout.foot + grid->rows * cell_height;
    page->height = layout.top + longest(grid->methods, grid->columns) * sin(turned) * name_slope + 4;
    return layout;
}

/* -1: the full colour of less error, 1: that of more. */
static double strength(double ratio) { return fmax(-1, fmin(1, log(ratio) / log(strongest))); }

static void name_colour(char colour[8], double ratio) {
    static const double less[] = {0x21, 0x66, 0xAC}, even[] = {0xF4, 0xF4, 0xF4}, more[] = {0xB3, 0x58, 0x06};
    const double t = strength(ratio);
    int parts[3];
    for (int i = 0; i < 3; i++) parts[i] = (int)lround(even[i] + fabs(t) * ((t < 0 ? less[i] : more[i]) - even[i]));
    snprintf(colour, 8, "#%02X%02X%02X", (unsigned)parts[0], (unsigned)parts[1], (unsigned)parts[2]);
}

static double linear(unsigned channel) { return pow(channel / 255.0, 2.2); }

/* White where it has a contrast of at least 3.5 (WCAG 2), else black. */
static const char *ink_on(const char colour[8]) {
    const double lightest = 1.05 / 3.5 - 0.05;
    const unsigned rgb = (unsigned)strtoul(colour + 1, NULL, 16);
    const double luminance = 0.2126 * linear(rgb >> 16) + 0.7152 * linear(rgb >> 8 & 255) + 0.0722 * linear(rgb & 255);
    return luminance < lightest ? "white" : "black";
}

static void draw_box(GnuplotPage *page, GnuplotBox box, const char *colour) {
    const GnuplotLook look = {"", {.colour = colour}, 0, false, 1, false};
    gnuplot_series_begin(page);
    gnuplot_bar(page, box.left, box.bottom, box.left + box.width, box.bottom + box.height);
    gnuplot_series_end(page, &look);
}

/* Two digits: "1/52", "1/3.1", "1", "×2.4"; what is beyond a factor of 9999 does not fit into a cell. */
static void name_ratio(char text[24], double ratio) {
    const double factor = ratio < 1 ? 1 / ratio : ratio;
    const char *before = ratio < 1 ? "1/" : "×";
    if (factor < 1.05)
        strcpy(text, "1");
    else if (!(factor < 9995))
        strcpy(text, ratio < 1 ? "<1/9999" : ">×9999");
    else if (factor < 9.95)
        snprintf(text, 24, "%s%.1f", before, factor);
    else
        snprintf(text, 24, "%s%.0f", before, factor < 99.5 ? factor : 10 * round(factor / 10));
}

static void draw_cell(const Layout *layout, int row, int column) {
    const EqualTimeCell *cell = &layout->grid->cells[row][column];
    const double x = column_x(layout, column), y = layout->top - (row + 1) * cell_height, edge = 0.25;
    char colour[8], text[24];
    if (!cell->ran) return;
    const bool none = isnan(cell->ratio);
    if (none)
        strcpy(colour, "#D8D8D8");
    else
        name_colour(colour, cell->ratio);
    draw_box(layout->page, (GnuplotBox){x + edge, y + edge, layout->cell - 2 * edge, cell_height - 2 * edge}, colour);
    if (none)
        strcpy(text, "–");
    else
        name_ratio(text, cell->ratio);
    gnuplot_text_in(layout->page, x + layout->cell / 2, y + cell_height / 2, "center", 7.5, text,
                    (GnuplotInk){ink_on(colour), 0});
}

static void draw_names(const Layout *layout) {
    const EqualTimeGrid *grid = layout->grid;
    for (int i = 0; i < grid->columns; i++) {
        const double middle = column_x(layout, i) + layout->cell / 2;
        gnuplot_text_in(layout->page, middle - 1, layout->top + 1.5, "left", 8, grid->methods[i],
                        (GnuplotInk){"black", degrees});
    }
    for (int i = 0; i < grid->rows; i++)
        gnuplot_text(layout->page, layout->left - 2, layout->top - (i + 0.5) * cell_height, "right", 8,
                     grid->scenes[i]);
}

/* The scale of colours, as a bar of steps. */
static void draw_scale(const Layout *layout) {
    static const double marks[] = {1.0 / 1000, 1.0 / 30, 1, 30, 1000};
    enum { STEPS = 61 };
    GnuplotPage *page = layout->page;
    const double bottom = layout->foot - 7.2;
    char text[24], colour[8], note[CHART_TEXT_SIZE + 64];
    for (int i = 0; i < STEPS; i++) {
        name_colour(colour, pow(strongest, 2 * (i + 0.5) / STEPS - 1));
        draw_box(page, (GnuplotBox){layout->left + bar_width * i / STEPS, bottom, bar_width / STEPS + 0.05, bar_height},
                 colour);
    }
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        name_ratio(text, marks[i]);
        gnuplot_text(page, layout->left + bar_width * (strength(marks[i]) + 1) / 2, bottom - 2, "center", 7, text);
    }
    snprintf(note, sizeof note, "in the time of momentum:%s; rivals learn nothing", layout->grid->time);
    gnuplot_text(page, layout->left + bar_width + 6, bottom + bar_height / 2, "left", 8,
                 "error at the impact / error of the best rival,");
    if (layout->grid->times[0] != '\0')
        gnuplot_text(page, layout->left, note_height / 2, "left", 8, layout->grid->times);
    gnuplot_text(page, layout->left + bar_width + 6, bottom - 2, "left", 8, note);
    gnuplot_text(page, layout->left + bar_width + 6, bottom - 5.5, "left", 8, "– slower than that, or lost the scene");
}

static void draw_grid(const EqualTimeGrid *grid, GnuplotPage *page) {
    Layout layout = lay_out(grid, page);
    gnuplot_page_begin(page, page->width, page->height);
    gnuplot_page_panel_begin(page);
    for (int row = 0; row < grid->rows; row++)
        for (int column = 0; column < grid->columns; column++) draw_cell(&layout, row, column);
    draw_names(&layout);
    draw_scale(&layout);
    gnuplot_panel_end(page);
    fprintf(page->script, "unset multiplot\n");
}

static bool draw(const EqualTimeGrid *grid, const char *folder, Error *error) {
    char stem[PATH_MAX], *text = NULL;
    size_t size = 0;
    if (!file_path(stem, sizeof stem, error, "%s/%s", folder, equal_time_layout.name)) return false;
    GnuplotPage page = {.script = memory_stream(&text, &size)};
    if (page.script == NULL) return error_memory(error, stem);
    draw_grid(grid, &page);
    bool whole = !ferror(page.script);
    whole = fclose(page.script) == 0 && whole && !page.no_memory;
    const GnuplotDrawing drawing = {.width = page.width,
                                    .height = page.height,
                                    .script = text,
                                    .script_size = size,
                                    .title = "Error at the impact in equal time / that of the best rival"};
    const bool drawn = whole ? gnuplot_draw(&drawing, stem, error) : error_memory(error, stem);
    free(text);
    return drawn;
}

static bool has_ratio(const EqualTimeGrid *grid) {
    for (int row = 0; row < grid->rows; row++)
        for (int column = 0; column < grid->columns; column++)
            if (!isnan(grid->cells[row][column].ratio) && grid->cells[row][column].ran) return true;
    return false;
}

bool equal_time_plot(const char *chart_csv, const char *folder, bool *drawn, Error *error) {
    ChartTable chart;
    EqualTime table;
    char path[CSV_PATH_SIZE], methods[CSV_PATH_SIZE];
    if (!csv_table_path(path, folder, &equal_time_layout, error) ||
        !csv_table_path(methods, folder, &equal_methods_layout, error) || !chart_csv_read(&chart, chart_csv, error))
        return false;
    EqualTimeGrid *grid = malloc(sizeof *grid);
    bool ok = grid != NULL || error_memory(error, path);
    ok = ok && equal_time_make(&table, chart.rows, chart.count, error);
    if (ok) {
        ok = csv_table_write(path, &equal_time_layout, table.rows, table.count, error) &&
             csv_table_write(methods, &equal_methods_layout, table.methods, table.method_count, error) &&
             equal_time_grid(grid, &table, chart_csv, error);
        if (ok) {
            chart_times_note(grid->times, chart.rows, chart.count);
            chart_make_plain(grid->times);
        }
        *drawn = ok && has_ratio(grid);
        ok = ok && (!*drawn || draw(grid, folder, error));
        equal_time_free(&table);
    }
    free(grid);
    chart_csv_free(&chart);
    return ok;
}
