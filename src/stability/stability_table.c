/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_table.h"

#include "chart/chart_data.h"
#include "common/csv.h"
#include "common/file.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#define LARGEST 1e30

enum { LEAST_NAME = 6 };

static const CsvColumn map_columns[] = {
    {"map", CSV_NAME, offsetof(MapCell, map), NULL, 0, 0},
    {"method", CSV_NAME, offsetof(MapCell, method), NULL, 0, 0},
    {"setting", CSV_TEXT, offsetof(MapCell, setting), NULL, 0, 0},
    {"x_parameter", CSV_NAME, offsetof(MapCell, x_parameter), NULL, 0, 0},
    {"x_unit", CSV_NAME, offsetof(MapCell, x_unit), NULL, 0, 0},
    {"x", CSV_NUMBER, offsetof(MapCell, x), NULL, -LARGEST, LARGEST},
    {"y_parameter", CSV_NAME, offsetof(MapCell, y_parameter), NULL, 0, 0},
    {"y_unit", CSV_NAME, offsetof(MapCell, y_unit), NULL, 0, 0},
    {"y", CSV_NUMBER, offsetof(MapCell, y), NULL, -LARGEST, LARGEST},
    {"verdict", CSV_WORD, offsetof(MapCell, verdict), verdict_words, 0, 0},
    {"frame", CSV_MAYBE, offsetof(MapCell, frame), NULL, 0, SCENE_MAX_FRAMES},
    {"body", CSV_MAYBE, offsetof(MapCell, body), NULL, -1, SCENE_MAX_BODIES},
    {"value", CSV_MAYBE, offsetof(MapCell, value), NULL, -LARGEST, LARGEST},
    {"unit", CSV_NAME, offsetof(MapCell, unit), NULL, 0, 0},
};

static const CsvColumn border_columns[] = {
    {"study", CSV_NAME, offsetof(BorderRow, study), NULL, 0, 0},
    {"method", CSV_NAME, offsetof(BorderRow, method), NULL, 0, 0},
    {"setting", CSV_TEXT, offsetof(BorderRow, setting), NULL, 0, 0},
    {"parameter", CSV_NAME, offsetof(BorderRow, parameter), NULL, 0, 0},
    {"unit", CSV_NAME, offsetof(BorderRow, unit), NULL, 0, 0},
    {"holds_at", CSV_MAYBE, offsetof(BorderRow, holds_at), NULL, -LARGEST, LARGEST},
    {"fails_at", CSV_MAYBE, offsetof(BorderRow, fails_at), NULL, -LARGEST, LARGEST},
    {"verdict", CSV_WORD, offsetof(BorderRow, verdict), verdict_words, 0, 0},
};

/* The header is line 1, and no field goes over a line's end (common/csv.h). */
bool stability_row_error(const char *path, int row, Error *error, const char *format, ...) {
    char where[600], what[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    snprintf(where, sizeof where, "%s:%d:1", path, row + 2);
    return error_input(error, where, "%s", what);
}

void map_cell_method(char method[MAP_METHOD_SIZE], const MapCell *cell) {
    snprintf(method, MAP_METHOD_SIZE, "%s%s%s", cell->method, cell->setting[0] != '\0' ? ":" : "", cell->setting);
}

void map_cell_clip(char name[MAP_CLIP_SIZE], const MapCell *cell) {
    static const char folder[] = "clips/";
    char method[MAP_METHOD_SIZE];
    map_cell_method(method, cell);
    snprintf(name, MAP_CLIP_SIZE, "%s%s-%s-%.4g_%.4g", folder, cell->map, method, cell->x, cell->y);
    file_name_clean(name + strlen(folder));
}

bool map_cell_same_method(const MapCell *a, const MapCell *b) {
    return strcmp(a->method, b->method) == 0 && strcmp(a->setting, b->setting) == 0;
}

static bool is_file_name(const char *name) {
    for (const char *c = name; *c != '\0'; c++)
        if (!isalnum((unsigned char)*c) && *c != '_' && *c != '-') return false;
    return name[0] != '\0';
}

static bool same_axes(const MapCell *a, const MapCell *b) {
    return strcmp(a->x_parameter, b->x_parameter) == 0 && strcmp(a->x_unit, b->x_unit) == 0 &&
           strcmp(a->y_parameter, b->y_parameter) == 0 && strcmp(a->y_unit, b->y_unit) == 0;
}

/* Row i begins a map, or a method of one: neither was there before. */
static bool check_first(const MapTable *table, int i, bool new_map, Error *error) {
    const MapCell *cell = &table->cells[i];
    if (new_map && !is_file_name(cell->map))
        return stability_row_error(table->path, i, error, "'%s' cannot be the name of a map", cell->map);
    for (int k = 0; k < i; k++) {
        if (strcmp(table->cells[k].map, cell->map) != 0) continue;
        if (new_map) return stability_row_error(table->path, i, error, "map %s was there before", cell->map);
        if (map_cell_same_method(&table->cells[k], cell))
            return stability_row_error(table->path, i, error, "this method of map %s was there before", cell->map);
    }
    return true;
}

static bool check_cells(const MapTable *table, Error *error) {
    int firsts = 0;
    for (int i = 0; i < table->count; i++) {
        const MapCell *cell = &table->cells[i], *last = i > 0 ? cell - 1 : cell;
        bool new_map = i == 0 || strcmp(last->map, cell->map) != 0;
        if (!new_map && !same_axes(last, cell))
            return stability_row_error(table->path, i, error, "other parameters than the row before has");
        if (!new_map && map_cell_same_method(last, cell)) continue;
        if (++firsts > STABILITY_MAX_PANELS)
            return stability_row_error(table->path, i, error, "more than %d methods of maps", STABILITY_MAX_PANELS);
        if (!check_first(table, i, new_map, error)) return false;
    }
    return true;
}

bool map_table_read(MapTable *table, const char *folder, Error *error) {
    *table = (MapTable){.count = 0};
    snprintf(table->path, sizeof table->path, "%s/maps.csv", folder);
    if (csv_is_bare(table->path)) return true;
    table->cells = csv_columns_read(folder, "maps", map_columns, sizeof map_columns / sizeof *map_columns,
                                    sizeof *table->cells, STABILITY_MAX_CELLS, &table->count, error);
    if (table->cells == NULL) return false;
    if (check_cells(table, error)) return true;
    map_table_free(table);
    return false;
}

void map_table_free(MapTable *table) {
    free(table->cells);
    *table = (MapTable){.count = 0};
}

/* Of a study the parameter is the first row's. */
static bool check_border(const BorderTable *table, int i, Error *error) {
    const BorderRow *row = &table->rows[i], *first = table->rows;
    while (strcmp(first->study, row->study) != 0) first++;
    if (strcmp(first->parameter, row->parameter) != 0 || strcmp(first->unit, row->unit) != 0)
        return stability_row_error(table->path, i, error, "another parameter than study %s had before", row->study);
    const char *verdict = verdict_words[row->verdict];
    bool holds = !isnan(row->holds_at), fails = !isnan(row->fails_at);
    if (row->verdict == LOOK_NOT_APPLICABLE)
        return (!holds && !fails) || stability_row_error(table->path, i, error, "'%s' cannot have a value", verdict);
    if (!verdict_holds((Verdict)row->verdict)) return true;
    return (holds && !fails) || stability_row_error(table->path, i, error, "'%s' does not fit the values", verdict);
}

bool border_table_read(BorderTable *table, const char *folder, Error *error) {
    *table = (BorderTable){.count = 0};
    snprintf(table->path, sizeof table->path, "%s/stability.csv", folder);
    if (csv_is_bare(table->path)) return true;
    table->rows = csv_columns_read(folder, "stability", border_columns, sizeof border_columns / sizeof *border_columns,
                                   sizeof *table->rows, STABILITY_MAX_BORDERS, &table->count, error);
    bool ok = table->rows != NULL;
    for (int i = 0; ok && i < table->count; i++) ok = check_border(table, i, error);
    if (!ok) border_table_free(table);
    return ok;
}

void border_table_free(BorderTable *table) {
    free(table->rows);
    *table = (BorderTable){.count = 0};
}

/* "k=10, warm=off"; of "k=5,network=DIR/net.npz": "k=5, net.npz". */
static size_t show_setting(char shown[2 * CSV_TEXT_SIZE], const char *setting) {
    size_t used = 0, item = 0;
    for (const char *c = setting; *c != '\0'; c++) {
        if (*c == '/') {
            used = item;
            continue;
        }
        shown[used++] = chart_plain_letter(*c);
        if (*c != ',') continue;
        shown[used++] = ' ';
        item = used;
    }
    shown[used] = '\0';
    return used;
}

/* What is too long loses the end of its name, as long as that leaves some: settings tell panels apart. */
void stability_method_text(char text[STABILITY_TEXT_SIZE], size_t most, const char *method, const char *setting) {
    char name[CSV_NAME_SIZE], shown[2 * CSV_TEXT_SIZE];
    size_t used = show_setting(shown, setting);
    snprintf(name, sizeof name, "%s", method);
    if (used > 0 && used + 2 + LEAST_NAME <= most) figure_cut(name, most - used - 2);
    snprintf(text, STABILITY_TEXT_SIZE, "%s%s%s", name, used > 0 ? ", " : "", shown);
    figure_cut(text, most);
}

/* An underline would be a subscript to gnuplot. */
void stability_axis_text(char text[STABILITY_TEXT_SIZE], const char *parameter, const char *unit) {
    snprintf(text, STABILITY_TEXT_SIZE, unit[0] != '\0' ? "%s (%s)" : "%s", parameter, unit);
    for (char *c = text; *c != '\0'; c++)
        if (*c == '_') *c = ' ';
    text[0] = (char)toupper((unsigned char)text[0]);
}
