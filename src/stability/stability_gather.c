/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_map.h"

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

static int find(const double *values, double value) {
    int i = 0;
    while (values[i] != value) i++;
    return i;
}

static bool gather_values(MapPanels *map, const MapTable *table, int first, int end, Error *error) {
    for (int i = first; i < end; i++)
        if (!insert(map->x, &map->x_count, table->cells[i].x) || !insert(map->y, &map->y_count, table->cells[i].y))
            return csv_table_error(&table->csv, i, 0, error, "more than %d values of a parameter", MAP_MAX_VALUES);
    return true;
}

static bool gather_looks(MapPanels *map, const MapTable *table, int first, int end, Error *error) {
    memset(map->looks, LOOK_MISSING, sizeof map->looks);
    for (int i = first; i < end; i++) {
        const MapCell *cell = &table->cells[i];
        if (i == first || !map_cell_same_method(cell - 1, cell)) {
            if (map->panel_count == MAP_MAX_METHODS)
                return csv_table_error(&table->csv, i, 0, error, "more than %d methods: too many for a figure",
                                       MAP_MAX_METHODS);
            map->methods[map->panel_count++] = cell;
        }
        unsigned char *look = &map->looks[map->panel_count - 1][find(map->x, cell->x)][find(map->y, cell->y)];
        if (*look != LOOK_MISSING)
            return csv_table_error(&table->csv, i, 0, error, "the cell appears twice (%s %g, %s %g)", cell->x_parameter,
                                   cell->x, cell->y_parameter, cell->y);
        *look = (unsigned char)cell->verdict;
    }
    return true;
}

bool map_panels_gather(MapPanels *map, const MapTable *table, int *row, Error *error) {
    int first = *row;
    *map = (MapPanels){.first = &table->cells[first]};
    while (*row < table->count && strcmp(table->cells[*row].map, map->first->map) == 0) ++*row;
    return gather_values(map, table, first, *row, error) && gather_looks(map, table, first, *row, error);
}
