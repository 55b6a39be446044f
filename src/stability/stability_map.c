/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_map.h"

#include "chart/chart_data.h"
#include "stability/map_axis.h"

#include <math.h>
#include <string.h>

/* mm */
static const double label_room = 8, right = 2, gap = 3.2, title_room = 6, axis_room = 9.5, row_gap = 1.5,
                    largest_cell = 4.6, least_height = 16, most_height = 52, border_width = 0.5, border_share = 0.35,
                    letter = 1.55, least_symbol_room = 2, symbol_distance = 3;

enum { LEGEND_COLUMNS = 6, LEGEND_COLUMNS_OF_ONE = 2 };

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
    layout.left = label_room + map_axis_width(map->y, map->y_count);
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

/* Small tiles have a symbol here and there: each would be a dot. */
static int symbols_every(double unit) { return unit < least_symbol_room ? (int)ceil(symbol_distance / unit) : 1; }

/* Not at the very edge, which would cut it. */
static bool has_symbol(int i, int count, int every) {
    return i % every == every / 2 && (every == 1 || i + every / 3 < count);
}

static void draw_tiles(const Layout *layout, int panel) {
    const MapPanels *map = layout->map;
    Tile tiles[MAP_MAX_VALUES * MAP_MAX_VALUES];
    TileScale scale = layout->cell;
    const int across = symbols_every(scale.unit_x), up = symbols_every(scale.unit_y);
    int count = 0;
    for (int x = 0; x < map->x_count; x++)
        for (int y = 0; y < map->y_count; y++)
            tiles[count++] = (Tile){x, y, map->looks[panel][x][y],
                                    !has_symbol(x, map->x_count, across) || !has_symbol(y, map->y_count, up)};
    scale.symbol_room = fmin(across * scale.unit_x, up * scale.unit_y);
    verdict_draw_tiles(layout->page, tiles, count, scale);
}

/* One holds and the other fails; cells without a verdict do neither. */
static bool differ(int look, int other) {
    return look < VERDICTS && other < VERDICTS && verdict_holds((Verdict)look) != verdict_holds((Verdict)other);
}

/* Drawn as bars: the ends of lines would leave notches at the corners. */
static void draw_border(const Layout *layout, int panel) {
    const MapPanels *map = layout->map;
    const GnuplotLook look = {"", {.colour = "black"}, 0, false, 1, false};
    const double width = fmin(border_width, border_share * fmin(layout->cell.unit_x, layout->cell.unit_y)),
                 across = width / 2 / layout->cell.unit_x, up = width / 2 / layout->cell.unit_y;
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
    map_axis_write(layout->page, 'x', map->x, map->x_count, layout->cell.unit_x,
                   panel + layout->columns >= map->panel_count ? x : NULL);
    map_axis_write(layout->page, 'y', map->y, map->y_count, layout->cell.unit_y, column == 0 ? y : NULL);
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
