/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "chart/equal_time_grid.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Columns in order: index of their family. */
typedef struct Columns {
    int count, family[EQUAL_TIME_COLUMNS];
    bool joined[EQUAL_TIME_COLUMNS];
} Columns;

static const char *twin_of(const RivalCurves *curves, int family) {
    const MethodDescription *method = curves->families[family].description;
    return method == NULL ? NULL : method->twin;
}

/* The family of the silenced twin of a learned one, or -1. */
static int find_twin(const RivalCurves *curves, int family) {
    char method[CHART_NAME_SIZE], name[CHART_FAMILY_SIZE];
    const char *twin = twin_of(curves, family), *colon = twin == NULL ? NULL : strchr(twin, ':');
    if (colon == NULL) return -1;
    snprintf(method, sizeof method, "%.*s", (int)(colon - twin), twin);
    const ChartRow row = {.method = method, .setting = colon + 1};
    chart_row_family(&row, name);
    for (int i = 0; i < curves->family_count; i++)
        if (i != family && strcmp(curves->families[i].name, name) == 0) return i;
    return -1;
}

/* A setting of a learned method that is some family's twin. */
static bool is_silenced(const RivalCurves *curves, int family) {
    for (int i = 0; twin_of(curves, family) != NULL && i < curves->family_count; i++)
        if (find_twin(curves, i) == family) return true;
    return false;
}

static void add(Columns *columns, int family, bool joined) {
    if (columns->count == EQUAL_TIME_COLUMNS) return;
    columns->family[columns->count] = family;
    columns->joined[columns->count++] = joined;
}

static void order_columns(Columns *columns, const RivalCurves *curves) {
    for (int i = 0; i < curves->family_count; i++)
        if (twin_of(curves, i) == NULL) add(columns, i, false);
    for (int i = 0; i < curves->family_count; i++) {
        const int twin = find_twin(curves, i);
        if (twin_of(curves, i) == NULL || is_silenced(curves, i)) continue;
        add(columns, i, false);
        if (twin >= 0) add(columns, twin, true);
    }
}

static int find_scene(EqualTimeGrid *grid, const char *scene) {
    char name[CHART_TEXT_SIZE];
    int i = 0;
    chart_plain(name, scene);
    while (i < grid->rows && strcmp(grid->scenes[i], name) != 0) i++;
    if (i == grid->rows && i < EQUAL_TIME_SCENES) strcpy(grid->scenes[grid->rows++], name);
    return i;
}

bool equal_time_grid(EqualTimeGrid *grid, const EqualTime *table, const char *path, Error *error) {
    const RivalCurves *curves = &table->curves;
    Columns columns = {0};
    int column_of[EQUAL_TIME_COLUMNS];
    *grid = (EqualTimeGrid){0};
    if (curves->family_count > EQUAL_TIME_COLUMNS)
        return error_input(error, path, "a figure has at most %d methods (got %d)", EQUAL_TIME_COLUMNS,
                           curves->family_count);
    order_columns(&columns, curves);
    grid->columns = columns.count;
    chart_plain(grid->time, table->time);
    for (int i = 0; i < columns.count; i++) {
        column_of[columns.family[i]] = i;
        chart_plain(grid->methods[i], curves->families[columns.family[i]].name);
        grid->joined[i] = columns.joined[i];
    }
    for (int i = 0; i < table->method_count; i++) {
        const EqualMethodRow *row = &table->methods[i];
        const int scene = find_scene(grid, row->scene);
        if (scene == EQUAL_TIME_SCENES)
            return error_input(error, path, "a figure has at most %d scenes", EQUAL_TIME_SCENES);
        grid->cells[scene][column_of[row->family]] = (EqualTimeCell){true, row->ratio};
    }
    return true;
}
