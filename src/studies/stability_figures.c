/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/csv.h"
#include "base/machine.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"
#include "studies/chart.h"
#include "studies/stability.h"
#include "studies/stability_internal.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Run {
    const GridContext *context;
    int first, cells;         /* of the piece */
    VerdictReading *readings; /* [cells, methods] */
    RunCounter counter;
} Run;

static StabilityPlace place_of(const StabilityGrid *grid) {
    return (StabilityPlace){grid->scenes, grid->map->scene, grid->map->file};
}

static Scene *read_scene(const StabilityGrid *grid, const SceneSetting *settings, int count, Error *error) {
    const StabilityPlace place = place_of(grid);
    return stability_scene(&place, settings, count, error);
}

static Scene *scene_at(const StabilityGrid *grid, double x, double y, Error *error) {
    SceneSetting settings[2] = {{.value = x}, {.value = y}};
    snprintf(settings[0].name, sizeof settings[0].name, "%s", grid->map->x.parameter);
    snprintf(settings[1].name, sizeof settings[1].name, "%s", grid->map->y.parameter);
    return read_scene(grid, settings, 2, error);
}

static bool judge_scene(Run *run, int i, const Scene *scene, const EnergyLog *converged, Error *error) {
    const GridContext *context = run->context;
    const StabilityMap *map = context->grid->map;
    const StabilityPlace place = place_of(context->grid);
    const VerdictRun judged = stability_verdict_run(&place, scene, map->stands, converged);
    for (int m = 0; m < context->method_count; m++)
        if (!verdict_run(&run->readings[i * context->method_count + m], scene, &context->methods[m]->method, &judged,
                         error) ||
            !run_counter_add(&run->counter, map->name, error))
            return false;
    return true;
}

static bool judge_cell(void *piece, int i, Error *error) {
    Run *run = piece;
    const GridContext *context = run->context;
    const int cell = run->first + i;
    EnergyLog converged = {0};
    Scene *scene =
        scene_at(context->grid, context->x[cell % context->x_count], context->y[cell / context->x_count], error);
    bool ok =
        scene != NULL && converged_run_once(&converged, scene, error) && judge_scene(run, i, scene, &converged, error);
    energy_log_free(&converged);
    scene_destroy(scene);
    return ok;
}

static bool write_cell(const Run *run, int i, int m, FILE *results, Error *error) {
    const GridContext *context = run->context;
    const StabilityMap *map = context->grid->map;
    const Contender *method = context->methods[m];
    const VerdictReading *reading = &run->readings[i * context->method_count + m];
    const int cell = run->first + i;
    const MapCell row = {.map = map->name,
                         .method = method->name,
                         .setting = method->setting,
                         .x_parameter = map->x.parameter,
                         .x_unit = stability_unit(context->typical, map->x.parameter),
                         .x = context->x[cell % context->x_count],
                         .y_parameter = map->y.parameter,
                         .y_unit = stability_unit(context->typical, map->y.parameter),
                         .y = context->y[cell / context->x_count],
                         .verdict = (int)reading->verdict,
                         .frame = reading->frame,
                         .body = reading->body,
                         .value = reading->value,
                         .unit = reading->unit};
    return piece_tables_print(results, &map_layout, (int)(method - context->grid->methods->items), &row, error);
}

/* Tests the first and the last cell. False with error set if the system fails. */
static bool find_whether_it_applies(const GridContext *context, const Method *method, bool *applies, Error *error) {
    Error reason = {0};
    *applies = true;
    for (int i = 0; *applies && i < 2; i++) {
        Scene *scene = scene_at(context->grid, context->x[i * (context->x_count - 1)],
                                context->y[i * (context->y_count - 1)], &reason);
        *applies = scene != NULL && stability_applies(method, scene, &reason);
        scene_destroy(scene);
    }
    if (reason.kind == ERROR_SYSTEM) *error = reason;
    return reason.kind != ERROR_SYSTEM;
}

static bool add_method(GridContext *context, const Contender *contender, Error *error) {
    const Method *method = &contender->method;
    bool applies;
    if (method->kind->description->role == METHOD_REFERENCE) return true;
    if (context->grid->map->iterations && !stability_takes_iterations(method)) return true;
    if (!find_whether_it_applies(context, method, &applies, error)) return false;
    if (applies) context->methods[context->method_count++] = contender;
    return true;
}

static int axis_values(const StabilityAxis *axis, bool quick, double values[BORDER_POINTS_MAX]) {
    BorderScan scan = axis->scan;
    if (quick) scan.points = axis->quick_points;
    return border_scan_values(&scan, values);
}

int stability_grid_cells(const StabilityMap *map, bool quick) {
    double values[BORDER_POINTS_MAX];
    return axis_values(&map->x, quick, values) * axis_values(&map->y, quick, values);
}

bool stability_grid_begin(GridContext *context, const StabilityGrid *grid, Error *error) {
    *context = (GridContext){.grid = grid, .typical = read_scene(grid, NULL, 0, error)};
    if (context->typical == NULL) return false;
    context->x_count = axis_values(&grid->map->x, grid->quick, context->x);
    context->y_count = axis_values(&grid->map->y, grid->quick, context->y);
    context->methods = malloc((size_t)grid->methods->count * sizeof *context->methods);
    if (context->methods == NULL) return error_memory(error, grid->map->name);
    for (int i = 0; i < grid->methods->count; i++)
        if (!add_method(context, &grid->methods->items[i], error)) return false;
    return true;
}

void stability_grid_end(GridContext *context) {
    free(context->methods);
    scene_destroy(context->typical);
    *context = (GridContext){0};
}

bool stability_grid_write(const GridContext *context, int first, int end, FILE *results, const Progress *progress,
                          Error *error) {
    const int cells = end - first, methods = context->method_count;
    const char *name = context->grid->map->name;
    if (methods == 0) return true;
    Run run = {.context = context,
               .first = first,
               .cells = cells,
               .readings = malloc((size_t)methods * (size_t)cells * sizeof *run.readings),
               .counter = {.progress = progress, .expected = (double)cells * methods}};
    const ParallelWork work = {judge_cell, &run};
    bool ok = (run.readings != NULL || error_memory(error, name)) && parallel_for(&work, cells, name, NULL, error);
    for (int m = 0; ok && m < methods; m++)
        for (int i = 0; ok && i < cells; i++) ok = write_cell(&run, i, m, results, error);
    free(run.readings);
    return ok;
}

#define LARGEST 1e30

enum { REASON_SIZE = 2048, VALUE_DIGITS = 9, REST_DIGITS = 4 };

#define TEXT(Row, member, size) \
    { #member, CSV_TEXT, .offset = offsetof(Row, member), .maximum = (size)-1 }
#define NAME(Row, member) \
    { #member, CSV_NAME, .offset = offsetof(Row, member) }
#define VERDICT(Row) \
    { "verdict", CSV_WORD, .offset = offsetof(Row, verdict), .words = verdict_words }
#define NUMBER(Row, member, sort, least, most, count) \
    { #member, sort, .offset = offsetof(Row, member), .minimum = least, .maximum = most, .digits = count }
#define COUNT(member) NUMBER(RunRow, member, CSV_INTEGER, 0, INT_MAX, 0)

static const CsvColumn map_columns[] = {
    NAME(MapCell, map),
    NAME(MapCell, method),
    TEXT(MapCell, setting, STABILITY_SETTING_SIZE),
    NAME(MapCell, x_parameter),
    NAME(MapCell, x_unit),
    NUMBER(MapCell, x, CSV_NUMBER, -LARGEST, LARGEST, VALUE_DIGITS),
    NAME(MapCell, y_parameter),
    NAME(MapCell, y_unit),
    NUMBER(MapCell, y, CSV_NUMBER, -LARGEST, LARGEST, VALUE_DIGITS),
    VERDICT(MapCell),
    NUMBER(MapCell, frame, CSV_OPTIONAL, 0, SCENE_MAX_FRAMES, VALUE_DIGITS),
    NUMBER(MapCell, body, CSV_OPTIONAL, -1, SCENE_MAX_BODIES, VALUE_DIGITS),
    NUMBER(MapCell, value, CSV_OPTIONAL, -LARGEST, LARGEST, 0),
    NAME(MapCell, unit),
};

/* The columns that these tables begin with. */
#define METHOD_COLUMNS(Row) NAME(Row, study), NAME(Row, method), TEXT(Row, setting, STABILITY_SETTING_SIZE)
#define PARAMETER_COLUMNS(Row) METHOD_COLUMNS(Row), NAME(Row, parameter), NAME(Row, unit)

static const CsvColumn border_columns[] = {
    PARAMETER_COLUMNS(BorderRow),
    NUMBER(BorderRow, holds_at, CSV_OPTIONAL, -LARGEST, LARGEST, VALUE_DIGITS),
    NUMBER(BorderRow, fails_at, CSV_OPTIONAL, -LARGEST, LARGEST, VALUE_DIGITS),
    VERDICT(BorderRow),
};

static const CsvColumn refusal_columns[] = {METHOD_COLUMNS(RefusalRow), TEXT(RefusalRow, reason, REASON_SIZE)};

static const CsvColumn rest_columns[] = {
    PARAMETER_COLUMNS(RunRow),
    NUMBER(RunRow, value, CSV_NUMBER, -LARGEST, LARGEST, VALUE_DIGITS),
    VERDICT(RunRow),
    COUNT(steps),
    NUMBER(RunRow, drift, CSV_OPTIONAL, 0, LARGEST, REST_DIGITS),
    NUMBER(RunRow, energy, CSV_OPTIONAL, -LARGEST, LARGEST, REST_DIGITS),
};

static const CsvColumn fallback_columns[] = {
    PARAMETER_COLUMNS(RunRow),
    NUMBER(RunRow, value, CSV_NUMBER, -LARGEST, LARGEST, VALUE_DIGITS),
    COUNT(steps),
    COUNT(not_finite),
    COUNT(outside_cone),
    COUNT(beyond_training),
    COUNT(by_sweeps),
};

const CsvLayout map_layout = CSV_LAYOUT("maps", map_columns, MapCell, .max_rows = STABILITY_MAX_CELLS);
const CsvLayout border_layout = CSV_LAYOUT("stability", border_columns, BorderRow, .max_rows = STABILITY_MAX_BORDERS);
const CsvLayout refusal_layout = CSV_LAYOUT("refusals", refusal_columns, RefusalRow, .max_rows = STABILITY_MAX_RUNS);
const CsvLayout rest_layout = CSV_LAYOUT("rest", rest_columns, RunRow, .max_rows = STABILITY_MAX_RUNS);
const CsvLayout fallback_layout = CSV_LAYOUT("fallbacks", fallback_columns, RunRow, .max_rows = STABILITY_MAX_RUNS);

static bool go_on(int done, int total, const char *folder, const Progress *progress, Error *error) {
    return progress_report(progress, done, total) ||
           error_interrupted(error, folder, "stopped; the tables are finished");
}

/* Gathers every map and, if `draw`, draws it. A first pass without drawing detects errors before anything is drawn. */
static bool process_maps(const MapTable *table, const char *folder, bool draw, const Progress *progress, Error *error) {
    MapPanels *map = malloc(sizeof *map);
    bool ok = map != NULL || error_memory(error, folder);
    for (int row = 0; ok && row < table->count;) {
        ok = go_on(row, table->count, folder, progress, error) && map_panels_gather(map, table, &row, error);
        if (!ok || !draw) continue;
        PlotPage page = {0};
        map_panels_write(map, &page);
        ok = plot_page_write(&page, folder, "map-", map->first->map, error);
        plot_page_free(&page);
    }
    free(map);
    return ok;
}

static bool draw_borders(const BorderTable *table, const char *folder, const Progress *progress, Error *error) {
    if (table->count == 0) return true;
    PlotPage page = {0};
    bool ok = go_on(0, 1, folder, progress, error) && stability_borders_write(table, &page, error) &&
              plot_page_write(&page, folder, "", "borders", error);
    plot_page_free(&page);
    return ok;
}

bool stability_figures_write(const char *folder, const Progress *progress, Error *error) {
    MapTable maps = {0};
    BorderTable borders = {0};
    bool ok = border_table_read(&borders, folder, error) && map_table_read(&maps, folder, error) &&
              process_maps(&maps, folder, false, NULL, error) && draw_borders(&borders, folder, progress, error) &&
              process_maps(&maps, folder, true, progress, error);
    map_table_free(&maps);
    border_table_free(&borders);
    return ok;
}
