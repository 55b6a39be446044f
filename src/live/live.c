/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The functions of the module that make runs. It calls what twinbox simulate calls, in the same order. */
#include "live/live.h"

#include "base/base.h"
#include "base/yaml.h"
#include "engine/engine.h"
#include "live/live_internal.h"
#include "methods/methods.h"
#include "runs/runs.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <stdlib.h>
#include <string.h>

struct LiveRun {
    Scene *scene;
    Method method;
    Simulation simulation;
    Trajectory *trajectory;
    SimulateVerdict verdict;
    int frame;     /* the last */
    Error failure; /* of a step */
};

static Error last_error;

Error *live_new_error(void) {
    last_error = (Error){0};
    return &last_error;
}

const char *live_error(void) { return last_error.message; }

void *live_reserve(int size) { return size > 0 ? malloc((size_t)size) : NULL; }

void live_release(void *memory) { free(memory); }

LiveScene *live_open(void *bundle, int size) {
    Error *error = live_new_error();
    LiveScene *scene = calloc(1, sizeof *scene);
    const Bundle all = {bundle, size > 0 && bundle != NULL ? (size_t)size : 0};
    Bundle tree;
    if (scene == NULL)
        error_memory(error, "bundle");
    else if (!bundle_is_whole(all) || !bundle_find(all, "scene", &tree))
        error_input(error, "bundle", "it is damaged");
    else if (bundle_tree(&scene->tree, tree, error)) {
        scene->bytes = bundle;
        scene->bundle = all;
        return scene;
    }
    free(scene);
    free(bundle);
    return NULL;
}

void live_close(LiveScene *scene) {
    if (scene == NULL) return;
    yaml_tree_free(&scene->tree);
    free(scene->bytes);
    free(scene);
}

/* The settings are those of --set, separated by commas. */
Scene *live_scene(LiveScene *live, const char *settings, Error *error) {
    enum { TEXT_MAX = 128 };
    SceneSettings values = {0};
    for (const char *at = settings; *at != '\0';) {
        char text[TEXT_MAX];
        const size_t length = strcspn(at, ",");
        if (length < sizeof text) memcpy(text, at, length);
        text[length < sizeof text ? length : 0] = '\0';
        if (!scene_settings_add(&values, text)) {
            error_input(error, "setting", "'%.*s' is not NAME=VALUE with a number after '='",
                        length < 64 ? (int)length : 64, at);
            return NULL;
        }
        at += length;
        if (*at == ',') at++;
    }
    return scene_of_tree(&live->tree, values.items, values.count, error);
}

LiveRun *live_begin(LiveScene *scene, const char *settings, const char *method, int contacts) {
    Error *error = live_new_error();
    LiveRun *run = calloc(1, sizeof *run);
    bundle_use(scene->bundle);
    if (run == NULL) return error_memory(error, "run"), NULL;
    run->scene = live_scene(scene, settings, error);
    bool ok = run->scene != NULL && method_parse(&run->method, method, error);
    if (ok) run->trajectory = trajectory_of_scene(run->scene, &run->method, run->scene->frames + 1, error);
    ok = run->trajectory != NULL && simulate_verdict_begin(&run->verdict, run->scene, &run->method, error) &&
         simulation_begin(&run->simulation, run->scene, &run->method, error);
    if (!ok) {
        live_end(run);
        return NULL;
    }
    run->trajectory->no_contacts = contacts == 0;
    trajectory_set_bodies(run->trajectory, 0, run->simulation.world);
    return run;
}

void live_end(LiveRun *run) {
    if (run == NULL) return;
    if (run->simulation.stepper != NULL) simulation_end(&run->simulation);
    simulate_verdict_free(&run->verdict);
    trajectory_destroy(run->trajectory);
    scene_destroy(run->scene);
    free(run);
}

int live_step(LiveRun *run, int count) {
    Trajectory *trajectory = run->trajectory;
    const World *world = run->simulation.world;
    for (; count > 0 && run->frame < run->scene->frames && run->failure.kind == ERROR_NONE; count--) {
        const int frame = run->frame + 1;
        if (!simulation_step(&run->simulation, frame, &run->failure) ||
            (!trajectory->no_contacts && !trajectory_set_contacts(trajectory, frame, world, &run->failure)) ||
            !verdict_watch_observe(&run->verdict.watch, frame, world, &run->failure))
            break;
        trajectory_set_bodies(trajectory, frame, world);
        run->frame = frame;
    }
    return run->frame;
}

const Trajectory *live_trajectory(const LiveRun *run) { return run->trajectory; }

const char *live_failure(const LiveRun *run) { return run->failure.message; }
int live_frames(const LiveRun *run) { return run->trajectory->frames; }
int live_bodies(const LiveRun *run) { return run->trajectory->bodies; }
int live_bomb(const LiveRun *run) { return run->trajectory->bomb; }
const float *live_sizes(const LiveRun *run) { return &run->trajectory->size->x; }
const float *live_masses(const LiveRun *run) { return run->trajectory->mass; }
const BodyName *live_names(const LiveRun *run) { return run->trajectory->name; }
const uint8_t *live_fixed(const LiveRun *run) { return run->trajectory->fixed; }
const float *live_positions(const LiveRun *run) { return &run->trajectory->position->x; }
const float *live_angles(const LiveRun *run) { return run->trajectory->angle; }
const float *live_velocities(const LiveRun *run) { return &run->trajectory->velocity->x; }
const float *live_spins(const LiveRun *run) { return run->trajectory->angular_velocity; }
const void *live_contacts(const LiveRun *run) { return run->trajectory->contacts; }

int live_contact_mode(const LiveRun *run, int contact) {
    int step = run->frame;
    while (live_contact_start(run, step) > contact) step--;
    return (int)trajectory_mode(run->trajectory, step, contact);
}

/* contact_start is filled up to the last step that had contacts. */
int live_contact_start(const LiveRun *run, int frame) {
    const int last = run->trajectory->last_step + 1;
    return frame < 0 ? 0 : (int)run->trajectory->contact_start[frame < last ? frame : last];
}

uint64_t live_hash(const LiveRun *run, int frame) {
    return frame >= 0 && frame <= run->frame ? trajectory_frame_hash(run->trajectory, frame) : 0;
}

/* The arrays of the copy are those of the run; ending the verdict changes none of them. */
bool live_verdict_of(const LiveRun *run, SimulateVerdict *verdict) {
    *verdict = run->verdict;
    return simulate_verdict_end(verdict, &run->failure);
}
