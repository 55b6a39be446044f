/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_grid.h"

#include "common/parallel.h"
#include "stability/stability_table.h"
#include "study/piece_tables.h"

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
