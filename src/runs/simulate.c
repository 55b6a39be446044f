/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/machine.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <string.h>

/* A run in progress. */
typedef struct Run {
    const Scene *scene;
    World *world;
    Stepper *stepper;
} Run;

static void run_end(Run *run) {
    stepper_destroy(run->stepper);
    world_destroy(run->world);
}

static bool run_begin(Run *run, const Scene *scene, const Method *method, Error *error) {
    const Launch own = launch_of(scene);
    if (scene->bomb.frame == 0 && !launches_check(scene, &own, 1, error)) return false;
    *run = (Run){.scene = scene, .world = scene_world(scene, error)};
    if (run->world != NULL) run->stepper = stepper_create(method, scene, error);
    if (run->stepper != NULL) return true;
    run_end(run);
    return false;
}

/* A method may have scattered the bodies: the scene is refused only if the bomb would start inside one in the engine's
   run, too. */
static bool add_bomb(const Scene *scene, World *world, Error *error) {
    const Launch own = launch_of(scene);
    return (launch_is_free(scene, world) || launches_check(scene, &own, 1, error)) &&
           scene_add_bomb(scene, world, error);
}

/* The bomb appears, and the last body disappears, after the steps that the scene sets. */
static bool update_bodies(const Scene *scene, World *world, int frame, Error *error) {
    if (frame == scene->last_body_until) world_remove_last_body(world);
    return !scene->bomb.present || scene->bomb.frame != frame || add_bomb(scene, world, error);
}

bool simulate_step(Stepper *stepper, World *world, const Step *step, Error *error) {
    if (stepper_step(stepper, world, step, error)) return update_bodies(step->scene, world, step->frame, error);
    error_add(error, ", in step %d of scene %s", step->frame, step->scene->name);
    return false;
}

static bool run_step(Run *run, int frame, Error *error) {
    return simulate_step(run->stepper, run->world, &(Step){.scene = run->scene, .frame = frame}, error);
}

static bool observe(const Run *run, int frame, const RunWatch *watch, Error *error) {
    if (watch->recorder != NULL && !recorder_record(watch->recorder, frame, run->world, error)) return false;
    for (int i = 0; i < watch->observer_count; i++)
        if (!watch->observers[i].observe(watch->observers[i].context, frame, run->world, error)) return false;
    if (watch->fallbacks != NULL) network_fallbacks_add(watch->fallbacks, &world_solution(run->world)->fallbacks);
    if (progress_report(watch->progress, frame, run->scene->frames)) return true;
    return error_interrupted(error, run->scene->name, "stopped after step %d of %d", frame, run->scene->frames);
}

bool simulate_watched(const Scene *scene, const Method *method, const RunWatch *watch, Error *error) {
    Run run;
    if (!run_begin(&run, scene, method, error)) return false;
    bool ok = watch->recorder == NULL || recorder_record(watch->recorder, 0, run.world, error);
    for (int frame = 1; ok && frame <= scene->frames; frame++)
        ok = run_step(&run, frame, error) && observe(&run, frame, watch, error);
    run_end(&run);
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
