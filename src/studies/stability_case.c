/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/csv.h"
#include "base/file.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "figures/sketch.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"
#include "studies/chart_internal.h"
#include "studies/stability.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
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

static const float shift = 1e-6f; /* m */

bool stability_path(char path[STABILITY_PATH_SIZE], const StabilityPlace *place, Error *error) {
    if (place->file != NULL) return file_path(path, STABILITY_PATH_SIZE, error, "%s", place->file);
    return file_path(path, STABILITY_PATH_SIZE, error, "%s/stability/%s.yaml", place->scenes, place->scene);
}

Scene *stability_scene(const StabilityPlace *place, const SceneSetting *settings, int count, Error *error) {
    char path[STABILITY_PATH_SIZE];
    return stability_path(path, place, error) ? scene_read_with(path, settings, count, error) : NULL;
}

VerdictRun stability_verdict_run(const StabilityPlace *place, const Scene *scene, bool stands,
                                 const EnergyLog *converged) {
    VerdictRun run = verdict_run_of(scene);
    if (place->file == NULL) {
        run.stands = stands;
        run.until_bomb = false;
    }
    run.converged = converged;
    return run;
}

const char *stability_unit(const Scene *scene, const char *parameter) {
    for (int i = 0; i < scene->parameter_count; i++)
        if (strcmp(scene->parameters[i].name, parameter) == 0) return scene->parameters[i].unit;
    return "";
}

void stability_shift(Scene *scene, int seed) {
    BodyDef *body = scene->bomb.present ? &scene->bomb.body : NULL;
    for (int i = scene->body_count - 1; i >= 0; i--)
        if (!scene->bodies[i].fixed) body = &scene->bodies[i];
    if (body == NULL || seed == 0) return;
    body->position.x += seed == 1 ? shift : -shift;
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

bool converged_run_once(EnergyLog *log, const Scene *scene, Error *error) {
    Method reference;
    Scene warm = *scene;
    warm.warm_starting = true;
    return method_parse(&reference, "reference", error) && energy_log_run(log, &warm, &reference, error);
}

static const EnergyLog *find(const ConvergedRuns *runs, double value) {
    const EnergyLog *log = NULL;
#pragma omp critical(converged_runs)
    for (int i = 0; i < runs->count; i++)
        if (runs->runs[i]->value == value) log = &runs->runs[i]->log;
    return log;
}

static bool store(ConvergedRuns *runs, ConvergedRun *run, Error *error) {
    bool ok;
#pragma omp critical(converged_runs)
    {
        ok = array_reserve((void **)&runs->runs, &runs->capacity, (size_t)runs->count + 1, sizeof *runs->runs);
        if (ok) runs->runs[runs->count++] = run;
    }
    return ok || error_memory(error, "converged run");
}

const EnergyLog *converged_runs_get(ConvergedRuns *runs, const Scene *scene, double value, Error *error) {
    const EnergyLog *known = find(runs, value);
    if (known != NULL) return known;
    ConvergedRun *run = calloc(1, sizeof *run);
    if (run == NULL) {
        error_memory(error, "converged run");
        return NULL;
    }
    run->value = value;
    if (converged_run_once(&run->log, scene, error) && store(runs, run, error)) return &run->log;
    energy_log_free(&run->log);
    free(run);
    return NULL;
}

void converged_runs_free(ConvergedRuns *runs) {
    for (int i = 0; i < runs->count; i++) {
        energy_log_free(&runs->runs[i]->log);
        free(runs->runs[i]);
    }
    free(runs->runs);
    *runs = (ConvergedRuns){0};
}
