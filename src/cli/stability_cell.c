/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/stability_cell.h"

#include "common/parse.h"

#include <math.h>
#include <string.h>

/* Of a number, in how far one that is typed may differ: a figure's have three digits. */
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

/* A list of names, each once, with ", " between; what has no room is left out. */
typedef struct Names {
    char text[1024];
    size_t used;
} Names;

static void add_name(Names *names, const char *name) {
    size_t length = strlen(name);
    for (const char *at = names->text; (at = strstr(at, name)) != NULL; at++) {
        bool begins = at == names->text || at[-1] == ' ', ends = at[length] == '\0' || at[length] == ',';
        if (begins && ends) return;
    }
    if (names->used + length + 3 > sizeof names->text) return;
    names->used += (size_t)snprintf(names->text + names->used, sizeof names->text - names->used, "%s%s",
                                    names->used > 0 ? ", " : "", name);
}

/* Of the part that is not there: what could have been said. */
static const MapCell *fail(const MapTable *table, const StabilityCell *cell, bool map_known, bool method_known,
                           Error *error) {
    Names names = {.used = 0}, ups = {.used = 0};
    char text[MAP_METHOD_SIZE];
    for (int i = 0; i < table->count; i++) {
        const MapCell *row = &table->cells[i];
        map_cell_method(text, row);
        if (map_known && strcmp(row->map, cell->map) != 0) continue;
        if (map_known && method_known && strcmp(text, cell->method) == 0) {
            snprintf(text, sizeof text, "%.9g", row->y);
            add_name(&ups, text);
            snprintf(text, sizeof text, "%.9g", row->x);
            add_name(&names, text);
        } else if (!map_known || !method_known)
            add_name(&names, map_known ? text : row->map);
    }
    if (!map_known)
        error_input(error, "--clip", "there is no map %s in %s; there are %s", cell->map, table->csv.csv.path,
                    names.used > 0 ? names.text : "none");
    else if (!method_known)
        error_input(error, "--clip", "map %s has no method %s; it has %s", cell->map, cell->method, names.text);
    else
        error_input(error, "--clip", "map %s has no cell %g,%g by %s; its X are %s; its Y are %s", cell->map, cell->x,
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
