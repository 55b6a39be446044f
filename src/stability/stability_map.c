/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_map.h"

#include "chart/chart_data.h"

#include <math.h>
#include <string.h>

/* mm */
static const double label_room = 8, right = 2, gap = 3.2, title_room = 6, axis_room = 9.5, row_gap = 1.5,
                    largest_cell = 4.6, least_height = 16, most_height = 52, border_width = 0.5, tic_height = 3,
                    tic_digit = 1.65, letter = 1.55;

enum { LEGEND_COLUMNS = 6, LEGEND_COLUMNS_OF_ONE = 2, TICS_SIZE = MAP_MAX_VALUES * 40 };

typedef struct Layout {
    const MapPanels *map;
    GnuplotPage *page;
    int columns, rows, legend_columns, legend_rows;
    double left, width, height, bottom; /* mm: left of the first panel, panel size, bottom of the lowest panel */
    TileScale cell;
    bool used[VERDICT_LOOKS];
} Layout;

static void find_used(Layout *layout) {
    const MapPanels *map = layout->map;
    for (int p = 0; p < map->panel_count; p++)
        for (int x = 0; x < map->x_count; x++)
            for (int y = 0; y < map->y_count; y++) layout->used[map->looks[p][x][y]] = true;
}

static int count_used(const Layout *layout) {
    int count = 0;
    for (int look = 0; look < VERDICT_LOOKS; look++) count += layout->used[look];
    return count;
}

/* Three significant digits; integers up to 1e6 in full. */
static int name_value(char *text, size_t size, double value) {
    bool whole = fabs(value) > 999 && fabs(value) < 1e6;
    return snprintf(text, size, whole ? "%.0f" : "%.3g", value);
}

/* mm: width of the longest label. */
static double number_width(const double *values, int count) {
    char text[32];
    int longest = 0;
    for (int i = 0; i < count; i++) {
        int length = name_value(text, sizeof text, values[i]);
        longest = length > longest ? length : longest;
    }
    return longest * tic_digit;
}

/* A single panel is one column of a printed page wide; several fill the page. */
static Layout lay_out(const MapPanels *map, GnuplotPage *page) {
    int panels = map->panel_count;
    Layout layout = {.map = map, .page = page};
    find_used(&layout);
    double page_width = panels == 1 ? FIGURE_COLUMN_WIDTH : FIGURE_PAGE_WIDTH;
    layout.columns = panels == 1 ? 1 : panels <= 4 ? 2 : panels <= 6 ? 3 : 4;
    layout.rows = (panels + layout.columns - 1) / layout.columns;
    layout.legend_columns = panels == 1 ? LEGEND_COLUMNS_OF_ONE : LEGEND_COLUMNS;
    /* The border is one more legend item. */
    layout.legend_rows = (count_used(&layout) + layout.legend_columns) / layout.legend_columns;
    layout.left = label_room + number_width(map->y, map->y_count);
    layout.width = (page_width - layout.left - right - gap * (layout.columns - 1)) / layout.columns;
    layout.cell.unit_x = layout.width / map->x_count;
    char label[STABILITY_TEXT_SIZE];
    stability_axis_text(label, map->first->y_parameter, map->first->y_unit);
    double least = fmax(least_height, letter * (double)strlen(label));
    layout.height = fmin(fmax(map->y_count * fmin(layout.cell.unit_x, largest_cell), least), most_height);
    layout.cell.unit_y = layout.height / map->y_count;
    layout.bottom = GNUPLOT_LEGEND_ROW * layout.legend_rows + axis_room + 1.5;
    page->width = page_width;
    page->height = layout.bottom + layout.rows * (layout.height + title_room) + (layout.rows - 1) * row_gap;
    return layout;
}

static void draw_tiles(const Layout *layout, int panel) {
    const MapPanels *map = layout->map;
    Tile tiles[MAP_MAX_VALUES * MAP_MAX_VALUES];
    int count = 0;
    for (int x = 0; x < map->x_count; x++)
        for (int y = 0; y < map->y_count; y++) tiles[count++] = (Tile){x, y, map->looks[panel][x][y]};
    verdict_draw_tiles(layout->page, tiles, count, layout->cell);
}

/* One holds and the other fails; cells without a verdict do neither. */
static bool differ(int look, int other) {
    return look < VERDICTS && other < VERDICTS && verdict_holds((Verdict)look) != verdict_holds((Verdict)other);
}

/* Drawn as bars: the ends of lines would leave notches at the corners. */
static void draw_border(const Layout *layout, int panel) {
    const MapPanels *map = layout->map;
    const GnuplotLook look = {"", {.colour = "black"}, 0, false, 1, false};
    double across = border_width / 2 / layout->cell.unit_x, up = border_width / 2 / layout->cell.unit_y;
    gnuplot_series_begin(layout->page);
    for (int x = 0; x < map->x_count; x++)
        for (int y = 0; y < map->y_count; y++) {
            int here = map->looks[panel][x][y];
            if (x + 1 < map->x_count && differ(here, map->looks[panel][x + 1][y]))
                gnuplot_bar(layout->page, x + 0.5 - across, y - 0.5 - up, x + 0.5 + across, y + 0.5 + up);
            if (y + 1 < map->y_count && differ(here, map->looks[panel][x][y + 1]))
                gnuplot_bar(layout->page, x - 0.5 - across, y + 0.5 - up, x + 0.5 + across, y + 0.5 + up);
        }
    gnuplot_series_end(layout->page, &look);
}

/* One tic per cell; labels are thinned so that they do not touch. */
static void write_axis(const Layout *layout, char axis, const double *values, int count, bool numbers,
                       const char *label) {
    char tics[TICS_SIZE], text[32];
    double room = axis == 'x' ? layout->cell.unit_x : layout->cell.unit_y;
    double needed = axis == 'x' ? number_width(values, count) + tic_digit : tic_height;
    int every = (int)ceil(needed / room);
    size_t used = (size_t)snprintf(tics, sizeof tics, "out%s (", axis == 'x' ? " offset 0,0.3" : "");
    for (int i = 0; i < count; i++) {
        name_value(text, sizeof text, values[i]);
        used += (size_t)snprintf(tics + used, sizeof tics - used, "%s'%s' %d", i > 0 ? ", " : "",
                                 numbers && i % every == 0 ? text : "", i);
    }
    snprintf(tics + used, sizeof tics - used, ")");
    gnuplot_linear_axis(layout->page, axis, -0.5, count - 0.5, tics, numbers ? label : NULL);
}

/* Links each cell to its clip; the title is the cell's name as for --clip, with special characters replaced. */
static void draw_links(const Layout *layout, int panel, GnuplotBox box) {
    const MapPanels *map = layout->map;
    const TileScale size = layout->cell;
    MapCell cell = *map->methods[panel];
    char method[MAP_METHOD_SIZE], clip[MAP_CLIP_SIZE], target[MAP_CLIP_SIZE + 4], title[MAP_CLIP_SIZE + 20];
    map_cell_method(method, &cell);
    for (int x = 0; x < map->x_count; x++)
        for (int y = 0; y < map->y_count; y++) {
            const int look = map->looks[panel][x][y];
            if (look >= VERDICTS) continue;
            cell.x = map->x[x];
            cell.y = map->y[y];
            map_cell_clip(clip, &cell);
            snprintf(target, sizeof target, "%s.mp4", clip);
            snprintf(title, sizeof title, "%s:%s:%.4g,%.4g %s", cell.map, method, cell.x, cell.y, verdict_words[look]);
            chart_make_plain(title);
            gnuplot_link(
                layout->page,
                (GnuplotBox){box.left + x * size.unit_x, box.bottom + y * size.unit_y, size.unit_x, size.unit_y},
                target, title);
        }
}

static void draw_panel(const Layout *layout, int panel) {
    const MapPanels *map = layout->map;
    int column = panel % layout->columns, row = panel / layout->columns;
    double step = layout->height + title_room + row_gap;
    GnuplotBox box = {layout->left + column * (layout->width + gap), layout->bottom + (layout->rows - 1 - row) * step,
                      layout->width, layout->height};
    char title[STABILITY_TEXT_SIZE], x[STABILITY_TEXT_SIZE], y[STABILITY_TEXT_SIZE];
    const MapCell *method = map->methods[panel];
    stability_method_text(title, (size_t)(layout->width / letter), method->method, method->setting);
    stability_axis_text(x, map->first->x_parameter, map->first->x_unit);
    stability_axis_text(y, map->first->y_parameter, map->first->y_unit);
    gnuplot_panel_begin(layout->page, box, title);
    write_axis(layout, 'x', map->x, map->x_count, panel + layout->columns >= map->panel_count, x);
    write_axis(layout, 'y', map->y, map->y_count, column == 0, y);
    draw_tiles(layout, panel);
    draw_border(layout, panel);
    draw_links(layout, panel, box);
    gnuplot_panel_end(layout->page);
}

static void draw_legend(const Layout *layout) {
    GnuplotPage *page = layout->page;
    const GnuplotLook border = {"", {.colour = "black"}, 0, false, 1, false};
    LegendPlace place = {layout->left, GNUPLOT_LEGEND_ROW * (layout->legend_rows - 0.5) + 0.5,
                         (page->width - layout->left) / layout->legend_columns, layout->legend_columns};
    gnuplot_page_panel_begin(page);
    int next = verdict_draw_legend(page, layout->used, &place);
    double x = place.left + place.width * (next % place.columns),
           y = place.top - GNUPLOT_LEGEND_ROW * (next / place.columns);
    gnuplot_series_begin(page);
    gnuplot_bar(page, x, y - border_width / 2, x + 2.9, y + border_width / 2);
    gnuplot_series_end(page, &border);
    gnuplot_text(page, x + 4.2, y, "left", 7.5, "border of holding");
    gnuplot_panel_end(page);
}

static void write_caption(const Layout *layout) {
    const MapPanels *map = layout->map;
    char x[STABILITY_TEXT_SIZE], y[STABILITY_TEXT_SIZE];
    stability_axis_text(x, map->first->x_parameter, map->first->x_unit);
    stability_axis_text(y, map->first->y_parameter, map->first->y_unit);
    fprintf(
        layout->page->caption,
        "Where each method fails: map %s. Across: %s; up: %s. Each cell is one run and its worst verdict; darker is "
        "worse. Settling, swaying and creeping count as holding; the black line separates them from failing. All "
        "cells have the same size, whatever their values.",
        map->first->map, x, y);
}

void map_panels_write(const MapPanels *map, GnuplotPage *page) {
    Layout layout = lay_out(map, page);
    gnuplot_page_begin(page, page->width, page->height);
    for (int panel = 0; panel < map->panel_count; panel++) draw_panel(&layout, panel);
    draw_legend(&layout);
    write_caption(&layout);
    gnuplot_page_end(page);
}
