/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_grid.h"

#include "common/parallel.h"
#include "stability/stability_table.h"
#include "study/study_parts.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct Run {
    const StabilityGrid *grid;
    Scene *typical; /* with default parameters */
    int x_count, y_count;
    double x[BORDER_POINTS_MAX], y[BORDER_POINTS_MAX];
    int method_count;
    const Contender **methods; /* [method_count] that apply to the scene */
    VerdictReading *readings;  /* [method_count, y_count, x_count] */
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

static bool judge_scene(Run *run, int cell, const Scene *scene, const EnergyLog *converged, Error *error) {
    const StabilityPlace place = place_of(run->grid);
    const VerdictRun judged = stability_verdict_run(&place, scene, run->grid->map->stands, converged);
    const int cells = run->x_count * run->y_count;
    for (int i = 0; i < run->method_count; i++)
        if (!verdict_run(&run->readings[i * cells + cell], scene, &run->methods[i]->method, &judged, error) ||
            !run_counter_add(&run->counter, run->grid->map->name, error))
            return false;
    return true;
}

static bool judge_cell(void *context, int cell, Error *error) {
    Run *run = context;
    EnergyLog converged = {0};
    Scene *scene = scene_at(run->grid, run->x[cell % run->x_count], run->y[cell / run->x_count], error);
    bool ok = scene != NULL && converged_run_once(&converged, scene, error) &&
              judge_scene(run, cell, scene, &converged, error);
    energy_log_free(&converged);
    scene_destroy(scene);
    return ok;
}

static bool write_cells(const Run *run, int method, FILE *lines, Error *error) {
    const StabilityMap *map = run->grid->map;
    MapCell row = {.map = map->name,
                   .method = run->methods[method]->name,
                   .setting = run->methods[method]->setting,
                   .x_parameter = map->x.parameter,
                   .x_unit = stability_unit(run->typical, map->x.parameter),
                   .y_parameter = map->y.parameter,
                   .y_unit = stability_unit(run->typical, map->y.parameter)};
    for (int cell = 0; cell < run->x_count * run->y_count; cell++) {
        const VerdictReading *reading = &run->readings[method * run->x_count * run->y_count + cell];
        row.x = run->x[cell % run->x_count];
        row.y = run->y[cell / run->x_count];
        row.verdict = (int)reading->verdict;
        row.frame = reading->frame;
        row.body = reading->body;
        row.value = reading->value;
        row.unit = reading->unit;
        if (!study_parts_print(lines, &map_layout, &row, error)) return false;
    }
    return true;
}

/* Tests the first and the last cell. False with error set if the system fails. */
static bool find_whether_it_applies(const Run *run, const Method *method, bool *applies, Error *error) {
    Error reason = {0};
    *applies = true;
    for (int i = 0; *applies && i < 2; i++) {
        Scene *scene = scene_at(run->grid, run->x[i * (run->x_count - 1)], run->y[i * (run->y_count - 1)], &reason);
        *applies = scene != NULL && stability_applies(method, scene, &reason);
        scene_destroy(scene);
    }
    if (reason.kind == ERROR_SYSTEM) *error = reason;
    return reason.kind != ERROR_SYSTEM;
}

static bool add_method(Run *run, const Contender *contender, Error *error) {
    const Method *method = &contender->method;
    bool applies;
    if (method->kind->description->role == METHOD_REFERENCE) return true;
    if (run->grid->map->iterations && !stability_takes_iterations(method)) return true;
    if (!find_whether_it_applies(run, method, &applies, error)) return false;
    if (applies) run->methods[run->method_count++] = contender;
    return true;
}

static bool begin(Run *run, Error *error) {
    const StabilityGrid *grid = run->grid;
    BorderScan x = grid->map->x.scan, y = grid->map->y.scan;
    if (grid->quick) x.points = grid->map->x.quick_points;
    if (grid->quick) y.points = grid->map->y.quick_points;
    run->x_count = border_scan_values(&x, run->x);
    run->y_count = border_scan_values(&y, run->y);
    run->typical = read_scene(grid, NULL, 0, error);
    if (run->typical == NULL) return false;
    const size_t cells = (size_t)run->x_count * (size_t)run->y_count, methods = (size_t)grid->methods->count;
    run->methods = malloc(methods * sizeof *run->methods);
    run->readings = malloc(methods * cells * sizeof *run->readings);
    if (run->methods == NULL || run->readings == NULL) return error_memory(error, grid->map->name);
    for (int i = 0; i < grid->methods->count; i++)
        if (!add_method(run, &grid->methods->items[i], error)) return false;
    run->counter.expected = (double)cells * run->method_count;
    return true;
}

bool stability_grid_write(void *grid, FILE *lines, const Progress *progress, Error *error) {
    Run run = {.grid = grid, .counter = {.progress = progress}};
    const ParallelWork work = {judge_cell, &run};
    bool ok = begin(&run, error) && (run.method_count == 0 ||
                                     parallel_for(&work, run.x_count * run.y_count, run.grid->map->name, NULL, error));
    for (int i = 0; ok && i < run.method_count; i++) ok = write_cells(&run, i, lines, error);
    free(run.methods);
    free(run.readings);
    scene_destroy(run.typical);
    return ok;
}
