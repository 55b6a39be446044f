/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One run of a stability study: its scene, its verdict, the converged run beside it; and maps, which have such a
   run in each cell. */
#include "base/base.h"
#include "base/file.h"
#include "base/machine.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"
#include "studies/contenders.h"
#include "studies/piece_tables.h"
#include "studies/stability.h"
#include "studies/stability_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const float shift = 1e-6f; /* m */

bool stability_path(char path[STABILITY_PATH_SIZE], const StabilityPlace *place, Error *error) {
    if (place->file != NULL) return file_path(path, STABILITY_PATH_SIZE, error, "%s", place->file);
    return file_path(path, STABILITY_PATH_SIZE, error, "%s/stability/%s.yaml", place->scenes, place->scene);
}

Scene *stability_scene(const StabilityPlace *place, const SceneSetting *settings, int count, Error *error) {
    char path[STABILITY_PATH_SIZE];
    return stability_path(path, place, error) ? scene_read_with(path, settings, count, error) : NULL;
}

Scene *stability_study_scene(const StabilityStudy *study, const char *scenes, double value, Error *error) {
    const StabilityPlace place = {scenes, study->scene, study->file};
    SceneSetting settings[2] = {{.value = value}, study->fixed};
    snprintf(settings[0].name, sizeof settings[0].name, "%s", study->parameter);
    return stability_scene(&place, settings, settings[1].name[0] != '\0' ? 2 : 1, error);
}

bool stability_is_struck(const StabilityPlace *place, const Scene *scene, bool stands) {
    return verdict_is_struck(scene) && (place->file != NULL || !stands);
}

/* The x of the first body that moves. */
static float *first_x(Scene *scene) {
    for (int i = 0; i < scene->body_count; i++)
        if (!scene->bodies[i].fixed) return &scene->bodies[i].position.x;
    return scene->bomb.present ? &scene->bomb.x.value : NULL;
}

void stability_shift(Scene *scene, int seed) {
    float *x = first_x(scene);
    if (x == NULL || seed == 0) return;
    *x += seed == 1 ? shift : -shift;
}

bool stability_applies(const Method *method, const Scene *scene, Error *error) {
    World *world = scene_world(scene, error);
    Stepper *stepper = world != NULL ? stepper_create(method, scene, error) : NULL;
    bool applies = stepper != NULL && simulate_step(stepper, world, &(Step){.scene = scene, .frame = 1}, error);
    stepper_destroy(stepper);
    world_destroy(world);
    return applies;
}

bool stability_takes_iterations(const Method *method) {
    return method->kind->solver != NULL && settings_known(method->kind->description->settings, "k") &&
           settings_get(&method->settings, "k") == NULL;
}

bool run_counter_add(RunCounter *counter, const char *what, Error *error) {
    bool stopped;
#pragma omp critical(run_counter)
    {
        counter->done++;
        double done = counter->done < counter->expected ? counter->done : counter->expected;
        if (!counter->stopped) counter->stopped = !progress_report(counter->progress, done, counter->expected);
        stopped = counter->stopped;
    }
    return !stopped || error_interrupted(error, what, "stopped; finished parts are kept");
}

bool verdict_run(VerdictReading *reading, const Scene *scene, const Method *method, double allowed, Error *error) {
    SimulateVerdict verdict = {0};
    Simulation run;
    Error failure = {0};
    if (!simulation_begin(&run, scene, method, error)) return false;
    bool ok = simulate_verdict_begin(&verdict, scene, method, error);
    verdict.watch.run.allowed = allowed;
    for (int frame = 1; ok && frame <= scene->frames && !verdict_watch_is_final(&verdict.watch); frame++)
        if (simulation_step(&run, frame, &failure)) {
            ok = verdict_watch_observe(&verdict.watch, frame, run.world, error);
        } else {
            fallbacks_add(&verdict.watch.fallbacks, &world_solution(run.world)->fallbacks);
            break;
        }
    if (ok && !simulate_verdict_end(&verdict, &failure)) *error = failure, ok = false;
    *reading = verdict.reading;
    simulate_verdict_free(&verdict);
    simulation_end(&run);
    return ok;
}

bool stability_truth(Scene *scene, ConvergedRun *run, Error *error) {
    Method reference;
    float *x = first_x(scene);
    const bool warm = scene->warm_starting;
    if (!method_parse(&reference, "reference", error)) return false;
    const float place = *x;
    bool ok = true;
    scene->warm_starting = true;
    for (int seed = 0; ok && seed < BORDER_SEEDS; seed++) {
        VerdictReading reading;
        stability_shift(scene, seed);
        ok = verdict_run(&reading, scene, &reference, 0, error);
        *x = place;
        if (!ok) break;
        if (seed == 0) run->truth = reading.verdict;
        const bool known = verdict_sound(reading.verdict) && reading.fallbacks.not_converged == 0;
        if (reading.verdict != run->truth || !known) run->truth = VERDICT_UNDECIDED;
        run->steps += reading.steps;
        fallbacks_add(&run->fallbacks, &reading.fallbacks);
    }
    scene->warm_starting = warm;
    return ok;
}

Verdict stability_compare(const VerdictReading *reading, Verdict truth, const Method *method) {
    const bool is_truth = method->kind->description->role == METHOD_REFERENCE,
               unknown = truth == VERDICT_UNDECIDED || reading->fallbacks.not_converged > 0;
    return is_truth && unknown && verdict_sound(reading->verdict) ? VERDICT_UNDECIDED : reading->verdict;
}

/* Without the explosion that it would be called by itself. */
static bool find_gain(const Scene *scene, ConvergedRun *run, Error *error) {
    VerdictReading reading;
    Method reference;
    Scene warm = *scene;
    warm.warm_starting = true;
    if (!method_parse(&reference, "reference", error) || !verdict_run(&reading, &warm, &reference, INFINITY, error))
        return false;
    run->steps = reading.steps;
    run->fallbacks = reading.fallbacks;
    run->gained = reading.fallbacks.not_converged == 0 ? reading.excess : 0;
    return true;
}

/* The run of the scene at the value by the method "reference", and its truth. NULL with error set if it fails. */
static const ConvergedRun *converged_run(ConvergedRuns *runs, Scene *scene, double value, bool struck, Error *error) {
    const ConvergedRun *known = NULL;
#pragma omp critical(converged_runs)
    for (int i = 0; i < runs->count; i++)
        if (runs->runs[i]->value == value) known = runs->runs[i];
    if (known != NULL) return known;
    ConvergedRun *run = calloc(1, sizeof *run);
    if (run == NULL) return error_memory(error, "converged run"), NULL;
    run->value = value;
    const bool ok = struck ? stability_truth(scene, run, error) : find_gain(scene, run, error);
    bool room = true;
#pragma omp critical(converged_runs)
    if (ok) {
        room = array_reserve((void **)&runs->runs, &runs->capacity, (size_t)runs->count + 1, sizeof *runs->runs);
        if (room) runs->runs[runs->count++] = run;
    }
    if (ok && (room || error_memory(error, "converged run"))) return run;
    free(run);
    return NULL;
}

/* The run with its shift. */
static bool run_shifted(Scene *scene, const JudgedRun *run, double allowed, VerdictReading *reading, Error *error) {
    float *x = first_x(scene);
    const float place = x != NULL ? *x : 0;
    const bool warm = scene->warm_starting;
    stability_shift(scene, run->seed);
    if (run->method->kind->description->role == METHOD_REFERENCE) scene->warm_starting = true;
    const bool ok = verdict_run(reading, scene, run->method, allowed, error);
    if (x != NULL) *x = place;
    scene->warm_starting = warm;
    return ok;
}

bool stability_judge(Scene *scene, const JudgedRun *run, ConvergedRuns *runs, VerdictReading *reading,
                     const ConvergedRun **beside, Error *error) {
    *beside = NULL;
    if (!run_shifted(scene, run, 0, reading, error)) return false;
    if (!run->struck && reading->verdict != VERDICT_EXPLODES) return true;
    *beside = converged_run(runs, scene, run->value, run->struck, error);
    if (*beside == NULL) return false;
    if (!run->struck) return run_shifted(scene, run, (*beside)->gained, reading, error);
    reading->verdict = stability_compare(reading, (*beside)->truth, run->method);
    return true;
}

void converged_runs_free(ConvergedRuns *runs) {
    for (int i = 0; i < runs->count; i++) free(runs->runs[i]);
    free(runs->runs);
    *runs = (ConvergedRuns){0};
}

bool unconverged_print(FILE *results, int section, MapCell *row, const ConvergedRun *beside, Error *error) {
    if (beside == NULL || beside->fallbacks.not_converged == 0) return true;
    row->steps = beside->steps;
    row->not_converged = beside->fallbacks.not_converged;
    row->residual = isfinite(beside->fallbacks.residual) ? beside->fallbacks.residual : NAN;
    return piece_tables_print(results, &unconverged_layout, section, row, error);
}

/* A map. */

typedef struct Run {
    const GridContext *context;
    int first, cells;            /* of the piece */
    VerdictReading *readings;    /* [cells, methods] */
    ConvergedRuns *converged;    /* [cells] of one value */
    const ConvergedRun **beside; /* [cells, methods] */
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

static bool judge_cell(void *piece, int i, Error *error) {
    Run *run = piece;
    const GridContext *context = run->context;
    const StabilityMap *map = context->grid->map;
    const StabilityPlace place = place_of(context->grid);
    const int cell = run->first + i;
    Scene *scene =
        scene_at(context->grid, context->x[cell % context->x_count], context->y[cell / context->x_count], error);
    bool ok = scene != NULL;
    for (int m = 0; ok && m < context->method_count; m++) {
        const int at = i * context->method_count + m;
        const JudgedRun judged = {&context->methods[m]->method, 0, 0, stability_is_struck(&place, scene, map->stands)};
        ok = stability_judge(scene, &judged, &run->converged[i], &run->readings[at], &run->beside[at], error) &&
             run_counter_add(&run->counter, map->name, error);
    }
    scene_destroy(scene);
    return ok;
}

static bool write_cell(const Run *run, int i, int m, FILE *results, Error *error) {
    const GridContext *context = run->context;
    const StabilityMap *map = context->grid->map;
    const Contender *method = context->methods[m];
    const VerdictReading *reading = &run->readings[i * context->method_count + m];
    const int cell = run->first + i;
    MapCell row = {.map = map->name,
                   .method = method->name,
                   .setting = method->setting,
                   .x_parameter = map->x.parameter,
                   .x_unit = scene_parameter_unit(context->typical, map->x.parameter),
                   .x = context->x[cell % context->x_count],
                   .y_parameter = map->y.parameter,
                   .y_unit = scene_parameter_unit(context->typical, map->y.parameter),
                   .y = context->y[cell / context->x_count],
                   .verdict = (int)reading->verdict,
                   .frame = reading->frame,
                   .body = reading->body,
                   .value = reading->value,
                   .unit = reading->unit};
    const int section = (int)(method - context->grid->methods->items);
    return piece_tables_print(results, &map_layout, section, &row, error) &&
           unconverged_print(results, section, &row, run->beside[i * context->method_count + m], error);
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
    /* The panel of the reference shows the truth of a struck scene. */
    const StabilityPlace place = place_of(grid);
    const bool struck = stability_is_struck(&place, context->typical, grid->map->stands);
    for (int i = 0; i < grid->methods->count; i++) {
        const Contender *contender = &grid->methods->items[i];
        const Method *method = &contender->method;
        Error reason = {0};
        if (method->kind->description->role == METHOD_REFERENCE && !struck) continue;
        if (grid->map->iterations && !stability_takes_iterations(method)) continue;
        bool applies = true;
        for (int k = 0; applies && k < 2; k++) { /* the first and the last cell */
            Scene *scene =
                scene_at(grid, context->x[k * (context->x_count - 1)], context->y[k * (context->y_count - 1)], &reason);
            applies = scene != NULL && stability_applies(method, scene, &reason);
            scene_destroy(scene);
        }
        if (reason.kind == ERROR_SYSTEM) return *error = reason, false;
        if (applies) context->methods[context->method_count++] = contender;
    }
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
               .converged = calloc((size_t)cells, sizeof *run.converged),
               .beside = malloc((size_t)methods * (size_t)cells * sizeof *run.beside),
               .counter = {.progress = progress, .expected = (double)cells * methods}};
    const ParallelWork work = {judge_cell, &run};
    bool ok = ((run.readings != NULL && run.converged != NULL && run.beside != NULL) || error_memory(error, name)) &&
              parallel_for(&work, cells, name, NULL, error);
    for (int m = 0; ok && m < methods; m++)
        for (int i = 0; ok && i < cells; i++) ok = write_cell(&run, i, m, results, error);
    for (int i = 0; run.converged != NULL && i < cells; i++) converged_runs_free(&run.converged[i]);
    free(run.readings);
    free(run.converged);
    free(run.beside);
    return ok;
}
