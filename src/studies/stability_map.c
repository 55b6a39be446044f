/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The figures of a stability study. A map has one place for each value, whatever the distance of the values. */
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "figures/plot.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "pixels/png.h"
#include "pixels/type.h"
#include "runs/verdict.h"
#include "studies/figure_words.h"
#include "studies/stability.h"
#include "studies/stability_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Inserts a value into a sorted list, if it is new. False if the list is full. */
static bool insert(double values[MAP_MAX_VALUES], int *count, double value) {
    int at = 0;
    while (at < *count && values[at] < value) at++;
    if (at < *count && values[at] == value) return true;
    if (*count == MAP_MAX_VALUES) return false;
    memmove(values + at + 1, values + at, (size_t)(*count - at) * sizeof *values);
    values[at] = value;
    ++*count;
    return true;
}

static int place_of(const double *values, double value) {
    int i = 0;
    while (values[i] != value) i++;
    return i;
}

bool map_panels_gather(MapPanels *map, const CsvTable *table, int *row, Error *error) {
    const int first = *row;
    memset(map, 0, sizeof *map); /* a literal would lie on the stack first, where 0.4 MB may be all there is */
    map->first = map_cell(table, first);
    while (*row < table->count && strcmp(map_cell(table, *row)->map, map->first->map) == 0) ++*row;
    for (int i = first; i < *row; i++)
        if (!insert(map->x, &map->x_count, map_cell(table, i)->x) ||
            !insert(map->y, &map->y_count, map_cell(table, i)->y))
            return csv_table_error(table, i, 0, error, "more than %d values of a parameter", MAP_MAX_VALUES);
    memset(map->looks, CELL_MISSING, sizeof map->looks);
    for (int i = first; i < *row; i++) {
        const MapCell *cell = map_cell(table, i);
        if (i == first || !map_cell_same_method(cell - 1, cell)) {
            if (map->panel_count == MAP_MAX_METHODS)
                return csv_table_error(table, i, 0, error, "more than %d methods: too many for a figure",
                                       MAP_MAX_METHODS);
            map->methods[map->panel_count++] = cell;
        }
        const int x = place_of(map->x, cell->x), y = place_of(map->y, cell->y);
        unsigned char *look = &map->looks[map->panel_count - 1][x][y];
        if (strcmp(cell->unit, "boxes") == 0) map->fell[map->panel_count - 1][x][y] = (int)cell->value;
        if (*look != CELL_MISSING)
            return csv_table_error(table, i, 0, error, "the cell appears twice (%s %g, %s %g)", cell->x_parameter,
                                   cell->x, cell->y_parameter, cell->y);
        *look = (unsigned char)cell->verdict;
    }
    return true;
}

/* mm */
static const double number_height = 3, number_points = 7.5, least_between_ticks = 1.2;

/* Three significant digits; integers up to 1e6 in full. */
static void name_value(char text[32], double value) {
    bool whole = fabs(value) > 999 && fabs(value) < 1e6;
    snprintf(text, 32, whole ? "%.0f" : "%.3g", value);
}

/* mm: width of the longest number of the values. */
static double map_axis_width(const double *values, int count) {
    char text[32];
    double widest = 0;
    for (int i = 0; i < count; i++) {
        name_value(text, values[i]);
        widest = fmax(widest, type_width(text, number_points));
    }
    return widest;
}

/* Which values have a label: every so many, from one on. */
typedef struct Labels {
    int first, every;
} Labels;

/* Digits that are not zero at the end, on average: 1 of 40, 2 of 41 and of 0.25. */
static double roughness(const double *values, int count, Labels labels) {
    double digits = 0, labelled = 0;
    for (int i = labels.first; i < count; i += labels.every, labelled++) {
        char text[32];
        snprintf(text, sizeof text, "%.2e", fabs(values[i]));
        digits += text[3] != '0' ? 3 : text[2] != '0' ? 2 : 1;
    }
    return digits / labelled;
}

/* All if there is room; else steps of 2, 5 or 10 values and so on, beginning where the labelled values are roundest. */
static Labels choose_labels(const double *values, int count, int least) {
    static const int steps[] = {1, 2, 5, 10, 20, 50, 100};
    Labels best = {0, least};
    for (size_t i = sizeof steps / sizeof *steps; i > 0; i--)
        if (steps[i - 1] >= least) best.every = steps[i - 1];
    if (least < 3) best.every = least;
    if (best.every >= count) return (Labels){0, count};
    const int every = best.every;
    for (int first = 1; first < every && first < count; first++)
        if (roughness(values, count, (Labels){first, every}) < roughness(values, count, best)) best.first = first;
    return best;
}

/* An axis with a place for each value, in the order of the values, 0 to count - 1. room: mm that a value has. Numbers
   are thinned so that they do not touch, to values that are as round as possible. The ticks must outlive the axis. */
static PlotAxis map_axis(PlotTicks *ticks, bool across, const double *values, int count, double room) {
    const double needed = across ? map_axis_width(values, count) + 1.7 : number_height;
    const Labels labels = choose_labels(values, count, (int)ceil(needed / room));
    PlotAxis axis = plot_linear_axis(-0.5, count - 0.5, NULL);
    ticks->count = 0;
    for (int i = 0; i < count; i++) {
        char text[32] = "";
        const bool labelled = i >= labels.first && (i - labels.first) % labels.every == 0;
        if (!labelled && room < least_between_ticks) continue;
        if (labelled) name_value(text, values[i]);
        plot_tick_add(ticks, i, false, text);
    }
    axis.ticks = ticks;
    axis.outside = true;
    return axis;
}

static bool fails(const MapPanels *map, int panel, int x, int y) {
    const int look = map->looks[panel][x][y];
    return look < VERDICTS && !verdict_holds((Verdict)look);
}

static bool holds(const MapPanels *map, int panel, int x, int y) {
    if (x < 0 || y < 0 || x >= map->x_count || y >= map->y_count) return false;
    const int look = map->looks[panel][x][y];
    return look < VERDICTS && verdict_holds((Verdict)look);
}

/* Blues, then orange to red to black: hues that the colour-blind can distinguish. */
const VerdictLook verdict_looks[VERDICT_LOOKS] = {
    [VERDICT_SETTLES] = {"settles", 0xEAF3FA, 0x7FA6BF, METHOD_CIRCLE, false, 0.35},
    [VERDICT_STANDS] = {"stands", 0xE6F1F9, 0x4E7A96, METHOD_DIAMOND, false, 0.35},
    [VERDICT_MOVES] = {"moves", 0xA3CBE5, 0x14486B, METHOD_CIRCLE, false, 0.8},
    [VERDICT_TOO_SHORT] = {"too short", 0xE4E0D0, 0x5A543C, METHOD_PENTAGON, false, 0.8},
    [VERDICT_UNDECIDED] = {"undecided", 0xF2F0E6, 0x6E6850, METHOD_PENTAGON, true, 0.8},
    [VERDICT_FALLS] = {"falls", 0xEE9A2E, 0x3D2000, METHOD_INVERTED_TRIANGLE, false, 0.9},
    [VERDICT_COLLAPSES] = {"collapses", 0xDF7F20, 0x3D2000, METHOD_TRIANGLE, false, 0.9},
    [VERDICT_HANGS] = {"hangs", 0xD9773C, 0x3D2000, METHOD_CIRCLE, true, 0.9},
    [VERDICT_SINKS] = {"sinks", 0xCF6414, 0xFFFFFF, METHOD_SQUARE, true, 0.9},
    [VERDICT_TUNNELS] = {"tunnels", 0xA83232, 0xFFFFFF, METHOD_DIAMOND, true, 0.95},
    [VERDICT_EXPLODES] = {"explodes", 0x6E1650, 0xFFFFFF, PLOT_STAR, false, 1.1},
    [VERDICT_NON_FINITE] = {"non-finite", 0x140A1C, 0xFFFFFF, PLOT_CROSS, false, 1.1},
    [VERDICT_ADAPTER_FAILED] = {"adapter failed", 0xB4B4B4, 0x202020, METHOD_TRIANGLE, true, 0.9}, /* no physics */
    [CELL_NOT_APPLICABLE] = {"not applicable", NO_COLOUR, 0x909090, VERDICT_STROKE, false, 1},
    [CELL_MISSING] = {"not run", NO_COLOUR, 0x909090, VERDICT_BARE, false, 1},
};

/* mm. Seams between small tiles would be most of what is seen; these overlap instead, as half-covered pixels would let
   the page through. */
static const double most_symbol = 2.0, seam = 0.07, overlap = 0.02, least_with_seam = 1.2, legend_tile = 2.9,
                    name_gap = 1.3, hatch_step = 1.1, number_room = 2.6, fell_points = 6, clear_of_hatch = 1.5;

/* Symbol width relative to a tile's smaller side. */
static const double symbol_share = 0.56;

void verdict_draw_symbol(Sketch *sketch, const Tile *tile, double width) {
    const VerdictLook *look = &verdict_looks[tile->look];
    const PlotStyle style = {.symbol = look->symbol, .open = look->open, .colour = look->ink};
    const double half = width / 2;
    const Pen pen = pen_line(look->ink, 1.2, NULL);
    if (look->symbol == VERDICT_STROKE)
        sketch_line(sketch, (Point){tile->at.x - half, tile->at.y - half},
                    (Point){tile->at.x + half, tile->at.y + half}, &pen);
    else if (look->symbol != VERDICT_BARE)
        plot_mark(sketch, tile->at, &style, look->size * half, 1.2);
}

bool verdict_differs(int look, int reference) {
    const int looks[] = {look, reference};
    int does[2]; /* 0: stands, 1: falls, 2: collapses, 3: is not sound */
    for (int i = 0; i < 2; i++) {
        if (looks[i] >= VERDICTS || looks[i] == VERDICT_UNDECIDED) return false;
        does[i] = !verdict_sound((Verdict)looks[i]) ? 3
                  : looks[i] == VERDICT_COLLAPSES   ? 2
                                                    : !verdict_holds((Verdict)looks[i]);
    }
    return does[0] != does[1];
}

void verdict_hatch(Sketch *sketch, Point low, Point high, uint32_t ink) {
    const double wide = high.x - low.x, tall = high.y - low.y;
    const Pen pen = pen_line(ink, 0.8, NULL);
    for (double at = hatch_step / 2; at < wide + tall; at += hatch_step)
        sketch_line(sketch, (Point){low.x + fmax(at - tall, 0), low.y + fmin(at, tall)},
                    (Point){low.x + fmin(at, wide), low.y + fmax(at - wide, 0)}, &pen);
}

/* Draws all fills, then all symbols. */
static void fill_tiles(Sketch *sketch, const Tile *tiles, int count, TileSize size) {
    const double inside = fmin(size.width, size.height) < least_with_seam ? -overlap : seam;
    const double x = size.width / 2 - inside, y = size.height / 2 - inside;
    for (int i = 0; i < count; i++) {
        const Point at = tiles[i].at;
        const uint32_t fill = verdict_looks[tiles[i].look].fill;
        if (fill == NO_COLOUR) continue;
        const Point low = {at.x - x, at.y - y}, high = {at.x + x, at.y + y};
        const Pen plain = {fill, 1, NO_COLOUR, 0, NULL};
        sketch_rectangle(sketch, low, high, &plain);
        if (!tiles[i].hatched) continue;
        verdict_hatch(sketch, low, high, verdict_looks[tiles[i].look].ink);
        if (!tiles[i].bare) sketch_dot(sketch, at, fmin(fmin(x, y), clear_of_hatch), &plain);
    }
    const double room = size.symbol_room > 0 ? size.symbol_room : fmin(size.width, size.height);
    for (int i = 0; i < count; i++) {
        const TextStyle style = {fell_points, TEXT_CENTER, verdict_looks[tiles[i].look].ink, 0, false};
        if (tiles[i].fell > 0 && fmin(size.width, size.height) >= number_room)
            sketch_text(sketch, tiles[i].at, &style, "%d", tiles[i].fell);
        else if (!tiles[i].bare)
            verdict_draw_symbol(sketch, &tiles[i], fmin(symbol_share * room, most_symbol));
    }
}

int verdict_draw_legend(Sketch *sketch, const bool used[VERDICT_LOOKS], const LegendPlace *place) {
    const Pen frame = pen_line(0x909090, 0.6, NULL); /* around a look without fill */
    const double half = legend_tile / 2 - seam;
    Tile tiles[VERDICT_LOOKS];
    int count = 0;
    for (int look = 0; look < VERDICT_LOOKS; look++) {
        if (!used[look]) continue;
        const double left = place->left + place->width * (count % place->columns);
        const Point at = {left + legend_tile / 2, place->top - LEGEND_ROW * (count / place->columns)};
        if (verdict_looks[look].fill == NO_COLOUR)
            sketch_rectangle(sketch, (Point){at.x - half, at.y - half}, (Point){at.x + half, at.y + half}, &frame);
        tiles[count++] = (Tile){.at = at, .look = look};
        plot_text(sketch, (Point){left + legend_tile + name_gap, at.y}, TEXT_LEFT, LEGEND_POINTS,
                  verdict_looks[look].name);
    }
    fill_tiles(sketch, tiles, count, (TileSize){.width = legend_tile, .height = legend_tile});
    return count;
}

/* 1: has a border between holding and failing; 0: holds everywhere; -1: fails everywhere; -2: has no verdict. */
static int border_of(const MapPanels *map, int panel) {
    bool any_holds = false, any_fails = false;
    for (int x = 0; x < map->x_count; x++)
        for (int y = 0; y < map->y_count; y++) {
            any_holds = any_holds || holds(map, panel, x, y);
            any_fails = any_fails || fails(map, panel, x, y);
        }
    return any_holds ? any_fails : any_fails ? -1 : -2;
}

void left_out_add(LeftOut *left_out, const char *why, const char *method, const char *setting) {
    char name[STABILITY_TEXT_SIZE];
    const size_t length = strlen(why);
    const bool next = left_out->count > 0 && strncmp(left_out->lines[left_out->count - 1], why, length) == 0;
    if (!next) left_out->count++;
    char *line = left_out->lines[left_out->count - 1];
    stability_method_text(name, method, setting);
    text_add(line, LEFT_OUT_SIZE, "%s%s", next ? ", " : why, name);
}

void left_out_add_unconverged(LeftOut *left_out, const CsvTable *unconverged, const char *study) {
    char text[UNCONVERGED_TEXT_SIZE];
    if (!stability_unconverged(unconverged, study, text)) return;
    const char *const why = "The reference did not converge: ";
    const bool next = left_out->count > 0 && strncmp(left_out->lines[left_out->count - 1], why, strlen(why)) == 0;
    if (!next) left_out->count++;
    text_add(left_out->lines[left_out->count - 1], LEFT_OUT_SIZE, "%s%s %s", next ? "; " : why, study, text);
}

/* "Left out, ...: a, b." in lines. */
static int wrap_left_out(char line[LEFT_OUT_SIZE], const LeftOut *left_out, int i, double width) {
    snprintf(line, LEFT_OUT_SIZE, "%.*s.", LEFT_OUT_SIZE - 2, left_out->lines[i]);
    return text_wrap(line, LEFT_OUT_SIZE, NOTE_POINTS, width);
}

int left_out_rows(const LeftOut *left_out, double width) {
    char line[LEFT_OUT_SIZE];
    int rows = 0;
    for (int i = 0; i < left_out->count; i++) rows += wrap_left_out(line, left_out, i, width);
    return rows;
}

void left_out_draw(const LeftOut *left_out, PlotPage *page, double left) {
    const double width = page->sketch.width - left - 1;
    double y = NOTE_ROW * (left_out_rows(left_out, width) - 0.5);
    for (int i = 0; i < left_out->count; i++) {
        char line[LEFT_OUT_SIZE];
        text_add(page->caption, sizeof page->caption, " %s.", left_out->lines[i]);
        const int rows = wrap_left_out(line, left_out, i, width);
        plot_text(&page->sketch, (Point){left, y}, TEXT_LEFT, NOTE_POINTS, line);
        y -= rows * NOTE_ROW;
    }
}

/* The panel of the reference, which only maps of struck scenes have; -1: none. */
static int reference_of(const MapPanels *map) {
    for (int panel = 0; panel < map->panel_count; panel++)
        if (strcmp(map->methods[panel]->method, "reference") == 0) return panel;
    return -1;
}

/* Where a method holds or fails everywhere, there is nothing to see, unless the reference is beside it. If no panel has
   a border, all stay. */
static bool is_kept(const MapPanels *map, int panel) {
    return border_of(map, panel) == 1 || (reference_of(map) >= 0 && border_of(map, panel) > -2);
}

static void leave_out(MapPanels *map, LeftOut *left_out) {
    static const char *const why[] = {
        "Left out, as holding everywhere: ", "Left out, as failing everywhere: ", "Left out, as not applicable: "};
    const int count = map->panel_count;
    int kept = 0;
    bool keep[MAP_MAX_METHODS];
    for (int panel = 0; panel < count; panel++) kept += keep[panel] = is_kept(map, panel);
    for (int kind = 0; kept > 0 && kind < 3; kind++)
        for (int panel = 0; panel < count; panel++)
            if (!keep[panel] && border_of(map, panel) == -kind)
                left_out_add(left_out, why[kind], map->methods[panel]->method, map->methods[panel]->setting);
    map->panel_count = kept > 0 ? 0 : count;
    for (int panel = 0; kept > 0 && panel < count; panel++) {
        if (!keep[panel]) continue;
        map->methods[map->panel_count] = map->methods[panel];
        memmove(map->fell[map->panel_count], map->fell[panel], sizeof map->fell[panel]);
        memmove(map->looks[map->panel_count++], map->looks[panel], sizeof map->looks[panel]);
    }
}

/* mm */
static const double label_room = 8, right = 2, gap = 3.2, title_room = 6, axis_room = 9.5, row_gap = 1.5,
                    largest_cell = 4.6, least_height = 16, most_height = 52, border_width = 0.5, border_share = 0.35,
                    least_symbol_room = 2, symbol_distance = 3;

enum { LEGEND_COLUMNS = 6, LEGEND_COLUMNS_OF_ONE = 2 };

typedef struct Layout {
    const MapPanels *map;
    Sketch *sketch;
    int legend_columns, legend_rows;
    double foot; /* mm, below the legend */
    PlotGrid grid;
    double cell_x, cell_y; /* mm: size of a cell */
    bool used[VERDICT_LOOKS];
    int reference; /* its panel is the first, and others are hatched where they differ; -1: none */
} Layout;

/* The title of a panel, in lines. */
static int wrap_title(char title[STABILITY_TEXT_SIZE], const MapPanels *map, int panel, double width) {
    stability_method_text(title, map->methods[panel]->method, map->methods[panel]->setting);
    return text_wrap(title, STABILITY_TEXT_SIZE, 8, width);
}

/* A single panel is one column of a printed page wide; several fill the page. */
static Layout lay_out(const MapPanels *map, const LeftOut *left_out, Sketch *sketch) {
    int panels = map->panel_count;
    Layout layout = {.map = map, .sketch = sketch, .reference = reference_of(map)};
    int used = layout.reference >= 0;
    for (int p = 0; p < panels; p++)
        for (int x = 0; x < map->x_count; x++)
            for (int y = 0; y < map->y_count; y++) layout.used[map->looks[p][x][y]] = true;
    for (int look = 0; look < VERDICT_LOOKS; look++) used += layout.used[look];
    PlotGrid grid = {.width = panels == 1 ? FIGURE_COLUMN_WIDTH : FIGURE_PAGE_WIDTH,
                     .left = label_room + map_axis_width(map->y, map->y_count),
                     .right = right,
                     .columns = panels == 2 || panels == 4 ? 2
                                : panels <= 6              ? (panels == 1 ? 1 : 3)
                                                           : 4,
                     .gap = gap};
    grid.rows = (panels + grid.columns - 1) / grid.columns;
    char title[STABILITY_TEXT_SIZE];
    int lines = 1;
    for (int panel = 0; panel < panels; panel++)
        lines = (int)fmax(lines, wrap_title(title, map, panel, plot_grid_box(&grid, 0).width));
    grid.top = title_room + (lines - 1) * line_height(8);
    grid.row_gap = grid.top + row_gap;
    layout.foot = NOTE_ROW * left_out_rows(left_out, grid.width - grid.left - 1);
    layout.legend_columns = panels == 1 ? LEGEND_COLUMNS_OF_ONE : LEGEND_COLUMNS - (layout.reference >= 0);
    /* The border is one more legend item. */
    layout.legend_rows = (used + layout.legend_columns) / layout.legend_columns;
    grid.bottom = layout.foot + LEGEND_ROW * layout.legend_rows + axis_room + 1.5;
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
    Tile *tiles = malloc((size_t)(map->x_count * map->y_count) * sizeof *tiles); /* the stack may be smaller */
    const int across = symbols_every(layout->cell_x), up = symbols_every(layout->cell_y), reference = layout->reference;
    int count = 0;
    layout->sketch->failed |= tiles == NULL;
    for (int x = 0; tiles != NULL && x < map->x_count; x++)
        for (int y = 0; y < map->y_count; y++)
            tiles[count++] = (Tile){.at = plot_place(plot, x, y),
                                    .look = map->looks[panel][x][y],
                                    .bare = !has_symbol(x, map->x_count, across) || !has_symbol(y, map->y_count, up),
                                    .fell = reference >= 0 ? map->fell[panel][x][y] : 0,
                                    .hatched = reference >= 0 &&
                                               verdict_differs(map->looks[panel][x][y], map->looks[reference][x][y])};
    fill_tiles(layout->sketch, tiles, count,
               (TileSize){layout->cell_x, layout->cell_y, fmin(across * layout->cell_x, up * layout->cell_y)});
    free(tiles);
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

static void draw_panel(const Layout *layout, int panel) {
    const MapPanels *map = layout->map;
    PlotTicks ticks[2];
    char title[STABILITY_TEXT_SIZE], x[STABILITY_TEXT_SIZE], y[STABILITY_TEXT_SIZE];
    const int place = panel == layout->reference ? 0 : panel + (panel < layout->reference);
    PlotPanel plot = {.box = plot_grid_box(&layout->grid, place), .title = title};
    wrap_title(title, map, panel, plot.box.width);
    stability_axis_text(x, map->first->x_parameter, map->first->x_unit);
    stability_axis_text(y, map->first->y_parameter, map->first->y_unit);
    plot.x = map_axis(&ticks[0], true, map->x, map->x_count, layout->cell_x);
    plot.y = map_axis(&ticks[1], false, map->y, map->y_count, layout->cell_y);
    if (place + layout->grid.columns >= map->panel_count) plot.x.label = x;
    if (place % layout->grid.columns == 0) plot.y.label = y;
    plot_panel_place(&plot);
    draw_tiles(layout, panel, &plot);
    draw_border(layout, panel, &plot);
    plot_panel_draw(layout->sketch, &plot);
}

static void draw_legend(const Layout *layout) {
    LegendPlace place = {layout->grid.left, layout->foot + LEGEND_ROW * (layout->legend_rows - 0.5) + 0.5,
                         (layout->grid.width - layout->grid.left) / layout->legend_columns, layout->legend_columns};
    const int next = verdict_draw_legend(layout->sketch, layout->used, &place);
    for (int i = 0; i <= (layout->reference >= 0); i++) {
        const double half = i == 0 ? border_width / 2 : legend_tile / 2;
        const Point at = {place.left + place.width * ((next + i) % place.columns),
                          place.top - LEGEND_ROW * ((next + i) / place.columns)},
                    low = {at.x, at.y - half}, high = {at.x + legend_tile, at.y + half};
        if (i == 0)
            sketch_rectangle(layout->sketch, low, high, &(Pen){0x000000, 1, NO_COLOUR, 0, NULL});
        else
            verdict_hatch(layout->sketch, low, high, 0x000000);
        plot_text(layout->sketch, (Point){at.x + legend_tile + name_gap, at.y}, TEXT_LEFT, LEGEND_POINTS,
                  i == 0 ? "border of holding" : HATCHED_WORDS);
    }
}

static void write_caption(const MapPanels *map, bool converged, PlotPage *page) {
    char x[STABILITY_TEXT_SIZE], y[STABILITY_TEXT_SIZE];
    stability_axis_text(x, map->first->x_parameter, map->first->x_unit);
    stability_axis_text(y, map->first->y_parameter, map->first->y_unit);
    text_add(
        page->caption, sizeof page->caption,
        "Where each method fails: map %s. Across: %s; up: %s. Each cell is one run and its worst verdict; darker is "
        "worse. Settling and moving count as holding; the black line separates them from failing. All "
        "cells have the same size, whatever their values.",
        map->first->map, x, y);
    if (reference_of(map) >= 0) text_add(page->caption, sizeof page->caption, " %s", stability_struck_words);
    if (!converged) text_add(page->caption, sizeof page->caption, " %s", stability_unconverged_words);
}

/* The figure and its caption. All cells have the same size; ticks show their values. */
static void write_map(MapPanels *map, const CsvTable *unconverged, PlotPage *page) {
    LeftOut left_out = {0};
    WordList words = {0};
    leave_out(map, &left_out);
    const int reasons = left_out.count;
    left_out_add_unconverged(&left_out, unconverged, map->first->map);
    const Layout layout = lay_out(map, &left_out, &page->sketch);
    sketch_begin(&page->sketch, layout.grid.width, layout.grid.height);
    for (int panel = 0; panel < map->panel_count; panel++) draw_panel(&layout, panel);
    draw_legend(&layout);
    write_caption(map, left_out.count == reasons, page);
    left_out_draw(&left_out, page, layout.grid.left);
    for (int panel = 0; panel < map->panel_count; panel++) words_add_method(&words, map->methods[panel]->method);
    for (int panel = 0; panel < map->panel_count; panel++)
        words_add_settings(&words, map->methods[panel]->method, map->methods[panel]->setting);
    words_join(&words, page->caption, sizeof page->caption);
}

static bool go_on(int done, int total, const char *folder, const Progress *progress, Error *error) {
    return progress_report(progress, done, total) ||
           error_interrupted(error, folder, "stopped; the tables are finished");
}

/* Gathers every map and, if `draw`, draws it. A first pass without drawing detects errors before anything is drawn. */
static bool process_maps(const CsvTable *table, const CsvTable *unconverged, const char *folder, bool draw,
                         const Progress *progress, Error *error) {
    MapPanels *map = malloc(sizeof *map);
    bool ok = map != NULL || error_memory(error, folder);
    for (int row = 0; ok && row < table->count;) {
        ok = go_on(row, table->count, folder, progress, error) && map_panels_gather(map, table, &row, error);
        if (!ok || !draw) continue;
        PlotPage page = {0};
        write_map(map, unconverged, &page);
        ok = plot_page_write(&page, folder, "map-", map->first->map, error);
        plot_page_free(&page);
    }
    free(map);
    return ok;
}

bool stability_figures_write(const char *folder, const StabilityOwn *own, const Progress *progress, Error *error) {
    CsvTable maps = {0};
    CsvTable borders = {0};
    CsvTable unconverged = {0};
    bool ok = csv_table_read_from(&borders, folder, &border_layout, error) &&
              csv_table_read_from(&maps, folder, &map_layout, error) &&
              csv_table_read_from(&unconverged, folder, &unconverged_layout, error) &&
              process_maps(&maps, &unconverged, folder, false, NULL, error);
    if (ok && borders.count > 0) {
        PlotPage page = {0};
        ok = go_on(0, 1, folder, progress, error) &&
             stability_borders_write(&borders, &unconverged, own, &page, error) &&
             plot_page_write(&page, folder, "", "borders", error);
        plot_page_free(&page);
    }
    ok = ok && process_maps(&maps, &unconverged, folder, true, progress, error);
    csv_table_free(&unconverged);
    csv_table_free(&maps);
    csv_table_free(&borders);
    return ok;
}
