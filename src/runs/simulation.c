/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run in progress: the world of a scene, and the method that steps it. Nothing is recorded here. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "runs/launch_check.h"
#include "runs/runs.h"
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
