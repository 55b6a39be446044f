/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/map_pages.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#define TEXT(member, size) \
    { #member, CSV_TEXT, .offset = offsetof(MapPage, member), .maximum = (size)-1 }
#define NAME(member) \
    { #member, CSV_NAME, .offset = offsetof(MapPage, member) }
#define NUMBER(member) \
    { #member, CSV_NUMBER, .offset = offsetof(MapPage, member), .minimum = -INFINITY, .maximum = INFINITY, .digits = 9 }
#define COUNT(member, least) \
    { #member, CSV_INTEGER, .offset = offsetof(MapPage, member), .minimum = least, .maximum = INT_MAX }

static const CsvColumn columns[] = {
    NAME(map),       NAME(method),    TEXT(setting, STABILITY_SETTING_SIZE),
    NUMBER(x),       NUMBER(y),       NUMBER(time),
    COUNT(frame, 0), COUNT(body, -1), TEXT(page, CSV_PATH_SIZE),
    COUNT(bytes, 0),
};

const CsvLayout map_page_layout =
    CSV_LAYOUT("map_pages", columns, MapPage, .max_rows = STABILITY_MAX_CELLS, .header = CSV_EXACT);

static bool fails(const MapPanels *map, int panel, int x, int y) {
    const int look = map->looks[panel][x][y];
    return look < VERDICTS && !verdict_holds((Verdict)look);
}

static bool holds(const MapPanels *map, int panel, int x, int y) {
    if (x < 0 || y < 0 || x >= map->x_count || y >= map->y_count) return false;
    const int look = map->looks[panel][x][y];
    return look < VERDICTS && verdict_holds((Verdict)look);
}

static bool is_at_border(const MapPanels *map, int panel, int x, int y) {
    return fails(map, panel, x, y) && (holds(map, panel, x - 1, y) || holds(map, panel, x + 1, y) ||
                                       holds(map, panel, x, y - 1) || holds(map, panel, x, y + 1));
}

int map_pages_choose(const MapPanels *map, int panel, MapPlace places[MAP_PAGES_EACH]) {
    MapPlace found[MAP_MAX_VALUES * MAP_MAX_VALUES], first = {-1, -1};
    int count = 0;
    for (int y = 0; y < map->y_count; y++)
        for (int x = 0; x < map->x_count; x++) {
            if (first.x < 0 && fails(map, panel, x, y)) first = (MapPlace){x, y};
            if (is_at_border(map, panel, x, y)) found[count++] = (MapPlace){x, y};
        }
    if (count == 0 && first.x >= 0) found[count++] = first;
    const int chosen = count < MAP_PAGES_EACH ? count : MAP_PAGES_EACH;
    for (int i = 0; i < chosen; i++) places[i] = found[chosen > 1 ? i * (count - 1) / (chosen - 1) : 0];
    return chosen;
}

const MapCell *map_panels_cell(const MapPanels *map, const MapTable *table, int panel, MapPlace place) {
    const MapCell *cell = map->methods[panel], *end = table->cells + table->count;
    for (; cell < end && strcmp(cell->map, map->first->map) == 0 && map_cell_same_method(cell, map->methods[panel]);
         cell++)
        if (cell->x == map->x[place.x] && cell->y == map->y[place.y]) return cell;
    return NULL;
}
