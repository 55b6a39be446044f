/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "stability/stability_case.h"

#include "common/array.h"
#include "common/file.h"

#include <stdio.h>
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
