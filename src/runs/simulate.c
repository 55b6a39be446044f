/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run in progress, which the module of live pages steps; then whole runs: observed, or recorded. */
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/launch_check.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

void simulation_end(Simulation *run) {
    stepper_destroy(run->stepper);
    world_destroy(run->world);
}

bool simulation_begin(Simulation *run, const Scene *scene, const Method *method, Error *error) {
    const Launch own = launch_of(scene);
    if (scene->bomb.frame == 0 && !launches_check(scene, &own, 1, error)) return false;
    *run = (Simulation){.scene = scene, .world = scene_world(scene, error)};
    if (run->world != NULL) run->stepper = stepper_create(method, scene, error);
    if (run->stepper != NULL) return true;
    simulation_end(run);
    return false;
}

bool simulate_step(Stepper *stepper, World *world, const Step *step, Error *error) {
    const Scene *scene = step->scene;
    if (!stepper_step(stepper, world, step, error)) {
        error_add(error, ", in step %d of scene %s", step->frame, scene->name);
        return false;
    }
    /* The bomb appears, and the last body disappears, after the steps that the scene sets. */
    if (step->frame == scene->last_body_until) world_remove_last_body(world);
    if (!scene->bomb.present || scene->bomb.frame != step->frame) return true;
    /* A method may have scattered the bodies: the scene is refused only if the bomb would start inside one in the
       engine's run, too. */
    const Launch own = launch_of(scene);
    return (launch_is_free(scene, world) || launches_check(scene, &own, 1, error)) &&
           scene_add_bomb(scene, world, error);
}

bool simulation_step(Simulation *run, int frame, Error *error) {
    return simulate_step(run->stepper, run->world, &(Step){.scene = run->scene, .frame = frame}, error);
}

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
    return ok && (watch->recorder == NULL || recorder_name_maker(watch->recorder, scene, method, error));
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
