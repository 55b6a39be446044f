/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/stability_cell.h"

#include "common/names.h"
#include "common/parse.h"

#include <math.h>
#include <string.h>

/* Relative tolerance of a typed number: figures show three digits. */
static const double share = 0.01;

static bool parse_values(const char *text, double *x, double *y) {
    const char *rest;
    return parse_leading_double(text, x, &rest) && *rest == ',' && parse_double(rest + 1, y);
}

bool stability_cell_parse(StabilityCell *cell, const char *text, Error *error) {
    const char *first = strchr(text, ':'), *last = strrchr(text, ':');
    bool parts = first != NULL && first > text && last > first + 1;
    if (!parts || (size_t)(first - text) >= sizeof cell->map || (size_t)(last - first) > sizeof cell->method ||
        !parse_values(last + 1, &cell->x, &cell->y))
        return error_input(error, "--clip", "'%s' is not MAP:METHOD:X,Y", text);
    snprintf(cell->map, sizeof cell->map, "%.*s", (int)(first - text), text);
    snprintf(cell->method, sizeof cell->method, "%.*s", (int)(last - first - 1), first + 1);
    return true;
}

static bool is_near(double value, double typed) { return fabs(value - typed) <= share * fabs(value); }

/* Names the known values of the part that was not found. */
static const MapCell *fail(const MapTable *table, const StabilityCell *cell, bool map_known, bool method_known,
                           Error *error) {
    NameList names = {0}, ups = {0};
    char text[MAP_METHOD_SIZE];
    for (int i = 0; i < table->count; i++) {
        const MapCell *row = &table->cells[i];
        map_cell_method(text, row);
        if (map_known && strcmp(row->map, cell->map) != 0) continue;
        if (map_known && method_known && strcmp(text, cell->method) == 0) {
            snprintf(text, sizeof text, "%.9g", row->y);
            name_list_add(&ups, text);
            snprintf(text, sizeof text, "%.9g", row->x);
            name_list_add(&names, text);
        } else if (!map_known || !method_known)
            name_list_add(&names, map_known ? text : row->map);
    }
    if (!map_known)
        error_input(error, "--clip", "there is no map %s in %s; its maps: %s", cell->map, table->csv.csv.path,
                    names.used > 0 ? names.text : "none");
    else if (!method_known)
        error_input(error, "--clip", "map %s has no method %s; its methods: %s", cell->map, cell->method, names.text);
    else
        error_input(error, "--clip", "map %s has no cell %g,%g of method %s; its X: %s; its Y: %s", cell->map, cell->x,
                    cell->y, cell->method, names.text, ups.text);
    return NULL;
}

static double distance(const MapCell *row, const StabilityCell *cell) {
    return fabs(row->x - cell->x) + fabs(row->y - cell->y);
}

const MapCell *stability_cell_find(const MapTable *table, const StabilityCell *cell, Error *error) {
    const MapCell *found = NULL;
    bool map_known = false, method_known = false;
    for (int i = 0; i < table->count; i++) {
        const MapCell *row = &table->cells[i];
        char method[MAP_METHOD_SIZE];
        if (strcmp(row->map, cell->map) != 0) continue;
        map_known = true;
        map_cell_method(method, row);
        if (strcmp(method, cell->method) != 0) continue;
        method_known = true;
        if (!is_near(row->x, cell->x) || !is_near(row->y, cell->y)) continue;
        if (found == NULL || distance(row, cell) < distance(found, cell)) found = row;
    }
    return found != NULL ? found : fail(table, cell, map_known, method_known, error);
}

const MapCell *stability_cell_holder(const MapTable *table, const MapCell *row) {
    for (int i = 0; i < table->count; i++) {
        const MapCell *other = &table->cells[i];
        if (strcmp(other->map, row->map) == 0 && other->x == row->x && other->y == row->y &&
            other->verdict < VERDICTS && verdict_holds((Verdict)other->verdict))
            return other;
    }
    return NULL;
}
