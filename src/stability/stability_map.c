/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_map.h"

#include "chart/chart_data.h"
#include "stability/map_axis.h"
#include "type/type.h"

#include <math.h>
#include <string.h>

/* mm */
static const double label_room = 8, right = 2, gap = 3.2, title_room = 6, axis_room = 9.5, row_gap = 1.5,
                    largest_cell = 4.6, least_height = 16, most_height = 52, border_width = 0.5, border_share = 0.35,
                    least_symbol_room = 2, symbol_distance = 3;

enum { LEGEND_COLUMNS = 6, LEGEND_COLUMNS_OF_ONE = 2 };

typedef struct Layout {
    const MapPanels *map;
    Sketch *sketch;
    int legend_columns, legend_rows;
    PlotGrid grid;
    double cell_x, cell_y; /* mm: size of a cell */
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
static Layout lay_out(const MapPanels *map, Sketch *sketch) {
    int panels = map->panel_count;
    Layout layout = {.map = map, .sketch = sketch};
    find_used(&layout);
    PlotGrid grid = {.width = panels == 1 ? FIGURE_COLUMN_WIDTH : FIGURE_PAGE_WIDTH,
                     .left = label_room + map_axis_width(map->y, map->y_count),
                     .right = right,
                     .top = title_room,
                     .columns = panels == 1   ? 1
                                : panels <= 4 ? 2
                                : panels <= 6 ? 3
                                              : 4,
                     .gap = gap,
                     .row_gap = title_room + row_gap};
    grid.rows = (panels + grid.columns - 1) / grid.columns;
    layout.legend_columns = panels == 1 ? LEGEND_COLUMNS_OF_ONE : LEGEND_COLUMNS;
    /* The border is one more legend item. */
    layout.legend_rows = (count_used(&layout) + layout.legend_columns) / layout.legend_columns;
    grid.bottom = LEGEND_ROW * layout.legend_rows + axis_room + 1.5;
    char label[STABILITY_TEXT_SIZE];
    stability_axis_text(label, map->first->y_parameter, map->first->y_unit);
    const double least = fmax(least_height, type_width(label, 8) + 1);
    layout.cell_x = plot_grid_box(&grid, 0).width / map->x_count;
    const double height = fmin(fmax(map->y_count * fmin(layout.cell_x, largest_cell), least), most_height);
    layout.cell_y = height / map->y_count;
    grid.height = grid.bottom + grid.rows * height + (grid.rows - 1) * grid.row_gap + grid.top;
    layout.grid = grid;
    return layout;
}

/* Small tiles have a symbol here and there: each would be a dot. */
static int symbols_every(double unit) { return unit < least_symbol_room ? (int)ceil(symbol_distance / unit) : 1; }

/* Not at the very edge, which would cut it. */
static bool has_symbol(int i, int count, int every) {
    return i % every == every / 2 && (every == 1 || i + every / 3 < count);
}

static void draw_tiles(const Layout *layout, int panel, const PlotPanel *plot) {
    const MapPanels *map = layout->map;
    Tile tiles[MAP_MAX_VALUES * MAP_MAX_VALUES];
    const int across = symbols_every(layout->cell_x), up = symbols_every(layout->cell_y);
    int count = 0;
    for (int x = 0; x < map->x_count; x++)
        for (int y = 0; y < map->y_count; y++)
            tiles[count++] = (Tile){plot_place(plot, x, y), map->looks[panel][x][y],
                                    !has_symbol(x, map->x_count, across) || !has_symbol(y, map->y_count, up)};
    verdict_draw_tiles(layout->sketch, tiles, count,
                       (TileSize){layout->cell_x, layout->cell_y, fmin(across * layout->cell_x, up * layout->cell_y)});
}

/* One holds and the other fails; cells without a verdict do neither. */
static bool differ(int look, int other) {
    return look < VERDICTS && other < VERDICTS && verdict_holds((Verdict)look) != verdict_holds((Verdict)other);
}

/* A bar along an edge, half its width longer at both ends: lines would leave notches at the corners. */
static void draw_edge(const Layout *layout, Point from, Point to) {
    const double half = fmin(border_width, border_share * fmin(layout->cell_x, layout->cell_y)) / 2;
    sketch_rectangle(layout->sketch, (Point){from.x - half, from.y - half}, (Point){to.x + half, to.y + half},
                     &(Pen){0x000000, 1, NO_COLOUR, 0, NULL});
}

static void draw_border(const Layout *layout, int panel, const PlotPanel *plot) {
    const MapPanels *map = layout->map;
    for (int x = 0; x < map->x_count; x++)
        for (int y = 0; y < map->y_count; y++) {
            const int here = map->looks[panel][x][y];
            const Point corner = plot_place(plot, x + 0.5, y + 0.5); /* the upper right one */
            if (x + 1 < map->x_count && differ(here, map->looks[panel][x + 1][y]))
                draw_edge(layout, (Point){corner.x, corner.y - layout->cell_y}, corner);
            if (y + 1 < map->y_count && differ(here, map->looks[panel][x][y + 1]))
                draw_edge(layout, (Point){corner.x - layout->cell_x, corner.y}, corner);
        }
}

/* Links each cell to its clip; the title is the cell's name as for --clip, with special characters replaced. */
static void draw_links(const Layout *layout, int panel, const PlotPanel *plot) {
    const MapPanels *map = layout->map;
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
            sketch_link(layout->sketch, plot_place(plot, x - 0.5, y - 0.5), plot_place(plot, x + 0.5, y + 0.5), target,
                        title);
        }
}

static void draw_panel(const Layout *layout, int panel) {
    const MapPanels *map = layout->map;
    const MapCell *method = map->methods[panel];
    PlotTicks ticks[2];
    char title[STABILITY_TEXT_SIZE], x[STABILITY_TEXT_SIZE], y[STABILITY_TEXT_SIZE];
    PlotPanel plot = {.box = plot_grid_box(&layout->grid, panel), .title = title};
    stability_method_text(title, 8, plot.box.width, method->method, method->setting);
    stability_axis_text(x, map->first->x_parameter, map->first->x_unit);
    stability_axis_text(y, map->first->y_parameter, map->first->y_unit);
    plot.x = map_axis(&ticks[0], true, map->x, map->x_count, layout->cell_x);
    plot.y = map_axis(&ticks[1], false, map->y, map->y_count, layout->cell_y);
    if (panel + layout->grid.columns >= map->panel_count) plot.x.label = x;
    if (panel % layout->grid.columns == 0) plot.y.label = y;
    plot_panel_place(&plot);
    draw_tiles(layout, panel, &plot);
    draw_border(layout, panel, &plot);
    draw_links(layout, panel, &plot);
    plot_panel_draw(layout->sketch, &plot);
}

static void draw_legend(const Layout *layout) {
    LegendPlace place = {layout->grid.left, LEGEND_ROW * (layout->legend_rows - 0.5) + 0.5,
                         (layout->grid.width - layout->grid.left) / layout->legend_columns, layout->legend_columns};
    const int next = verdict_draw_legend(layout->sketch, layout->used, &place);
    const Point at = {place.left + place.width * (next % place.columns),
                      place.top - LEGEND_ROW * (next / place.columns)};
    sketch_rectangle(layout->sketch, (Point){at.x, at.y - border_width / 2},
                     (Point){at.x + 2.9, at.y + border_width / 2}, &(Pen){0x000000, 1, NO_COLOUR, 0, NULL});
    plot_text(layout->sketch, (Point){at.x + 4.2, at.y}, TEXT_LEFT, LEGEND_POINTS, "border of holding");
}

static void write_caption(const MapPanels *map, char caption[PLOT_CAPTION_SIZE]) {
    char x[STABILITY_TEXT_SIZE], y[STABILITY_TEXT_SIZE];
    stability_axis_text(x, map->first->x_parameter, map->first->x_unit);
    stability_axis_text(y, map->first->y_parameter, map->first->y_unit);
    snprintf(
        caption, PLOT_CAPTION_SIZE,
        "Where each method fails: map %s. Across: %s; up: %s. Each cell is one run and its worst verdict; darker is "
        "worse. Settling, swaying and creeping count as holding; the black line separates them from failing. All "
        "cells have the same size, whatever their values.\n",
        map->first->map, x, y);
}

void map_panels_write(const MapPanels *map, PlotPage *page) {
    const Layout layout = lay_out(map, &page->sketch);
    sketch_begin(&page->sketch, layout.grid.width, layout.grid.height);
    for (int panel = 0; panel < map->panel_count; panel++) draw_panel(&layout, panel);
    draw_legend(&layout);
    write_caption(map, page->caption);
}
