/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_table.h"

#include "chart/chart_data.h"
#include "common/file.h"
#include "common/method_look.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

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

/* Row i is the first of a map, or of a method of one: neither may have appeared before. */
static bool check_first(const MapTable *table, int i, bool new_map, Error *error) {
    const MapCell *cell = &table->cells[i];
    if (new_map && !is_file_name(cell->map))
        return csv_table_error(&table->csv, i, 0, error, "map: '%s' is not a file name", cell->map);
    for (int k = 0; k < i; k++) {
        if (strcmp(table->cells[k].map, cell->map) != 0) continue;
        if (new_map)
            return csv_table_error(&table->csv, i, 0, error, "the rows of map '%s' are not together", cell->map);
        if (map_cell_same_method(&table->cells[k], cell))
            return csv_table_error(&table->csv, i, 0, error, "the rows of this method of map '%s' are not together",
                                   cell->map);
    }
    return true;
}

static bool check_cells(const MapTable *table, Error *error) {
    int firsts = 0;
    for (int i = 0; i < table->count; i++) {
        const MapCell *cell = &table->cells[i], *last = i > 0 ? cell - 1 : cell;
        bool new_map = i == 0 || strcmp(last->map, cell->map) != 0;
        if (!new_map && !same_axes(last, cell))
            return csv_table_error(&table->csv, i, 0, error, "the parameters differ from those of the row before");
        if (!new_map && map_cell_same_method(last, cell)) continue;
        if (++firsts > STABILITY_MAX_PANELS)
            return csv_table_error(&table->csv, i, 0, error, "more than %d methods of maps", STABILITY_MAX_PANELS);
        if (!check_first(table, i, new_map, error)) return false;
    }
    return true;
}

bool map_table_read(MapTable *table, const char *folder, Error *error) {
    *table = (MapTable){.count = 0};
    if (!csv_table_read_from(&table->csv, folder, &map_layout, error)) return false;
    table->cells = table->csv.rows;
    table->count = table->csv.count;
    if (check_cells(table, error)) return true;
    map_table_free(table);
    return false;
}

void map_table_free(MapTable *table) {
    csv_table_free(&table->csv);
    *table = (MapTable){.count = 0};
}

/* The parameter of a study is that of its first row. */
static bool check_border(const BorderTable *table, int i, Error *error) {
    const BorderRow *row = &table->rows[i], *first = table->rows;
    while (strcmp(first->study, row->study) != 0) first++;
    if (strcmp(first->parameter, row->parameter) != 0 || strcmp(first->unit, row->unit) != 0)
        return csv_table_error(&table->csv, i, 0, error, "the study '%s' had another parameter before", row->study);
    const char *verdict = verdict_words[row->verdict];
    bool holds = !isnan(row->holds_at), fails = !isnan(row->fails_at);
    if (row->verdict == LOOK_NOT_APPLICABLE)
        return (!holds && !fails) || csv_table_error(&table->csv, i, 0, error, "'%s' cannot have values", verdict);
    if (!verdict_holds((Verdict)row->verdict)) return true;
    return (holds && !fails) || csv_table_error(&table->csv, i, 0, error, "'%s' contradicts the values", verdict);
}

bool border_table_read(BorderTable *table, const char *folder, Error *error) {
    *table = (BorderTable){.count = 0};
    if (!csv_table_read_from(&table->csv, folder, &border_layout, error)) return false;
    table->rows = table->csv.rows;
    table->count = table->csv.count;
    for (int i = 0; i < table->count; i++) {
        if (check_border(table, i, error)) continue;
        border_table_free(table);
        return false;
    }
    return true;
}

void border_table_free(BorderTable *table) {
    csv_table_free(&table->csv);
    *table = (BorderTable){.count = 0};
}

bool border_same_method(const BorderRow *a, const BorderRow *b) {
    return strcmp(a->method, b->method) == 0 && strcmp(a->setting, b->setting) == 0;
}

bool border_same_study(const BorderRow *a, const BorderRow *b) { return strcmp(a->study, b->study) == 0; }

void stability_method_text(char text[STABILITY_TEXT_SIZE], double points, double most, const char *method,
                           const char *setting) {
    char whole[CSV_NAME_SIZE + STABILITY_SETTING_SIZE];
    snprintf(whole, sizeof whole, "%s%s%s", method, setting[0] != '\0' ? ":" : "", setting);
    method_name(text, STABILITY_TEXT_SIZE, whole);
    chart_make_plain(text);
    text_fit(text, STABILITY_TEXT_SIZE, points, most);
}

/* Words instead of the names of tables. */
void stability_axis_text(char text[STABILITY_TEXT_SIZE], const char *parameter, const char *unit) {
    snprintf(text, STABILITY_TEXT_SIZE, unit[0] != '\0' ? "%s (%s)" : "%s", parameter, unit);
    for (char *c = text; *c != '\0'; c++)
        if (*c == '_') *c = ' ';
    text[0] = (char)toupper((unsigned char)text[0]);
}
