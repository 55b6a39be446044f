/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Whole runs: a scene stepped to its end, observed or recorded. */
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <string.h>

bool simulate_watched(const Scene *scene, const Method *method, const RunWatch *watch, Error *error) {
    Simulation run;
    if (!simulation_begin(&run, scene, method, error)) return false;
    bool ok = watch->recorder == NULL || recorder_record(watch->recorder, 0, run.world, error);
    for (int frame = 1; ok && frame <= scene->frames; frame++) {
        ok = simulation_step(&run, frame, error) &&
             (watch->recorder == NULL || recorder_record(watch->recorder, frame, run.world, error));
        for (int i = 0; ok && i < watch->observer_count; i++)
            ok = watch->observers[i].observe(watch->observers[i].context, frame, run.world, error);
        if (!ok) break;
        if (watch->fallbacks != NULL) fallbacks_add(watch->fallbacks, &world_solution(run.world)->fallbacks);
        ok = progress_report(watch->progress, frame, scene->frames) ||
             error_interrupted(error, scene->name, "stopped after step %d of %d", frame, scene->frames);
    }
    simulation_end(&run);
    if (ok && watch->recorder != NULL) recorder_name_program(watch->recorder, method);
    return ok;
}

bool simulate_observed(const Scene *scene, const Method *method, const StepObserver *observer, Error *error) {
    return simulate_watched(scene, method, &(RunWatch){.observers = observer, .observer_count = 1}, error);
}

Trajectory *simulate(const Scene *scene, const Method *method, const Progress *progress, Error *error) {
    Recorder *recorder = recorder_create(scene, method, error);
    if (recorder == NULL) return NULL;
    const RunWatch watch = {.recorder = recorder, .progress = progress};
    Trajectory *run = simulate_watched(scene, method, &watch, error) ? recorder_take(recorder) : NULL;
    recorder_destroy(recorder);
    return run;
}
