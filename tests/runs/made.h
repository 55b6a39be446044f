/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes, methods, steppers and runs that must be in order. */
#pragma once
#include "testing.h"

#include "runs/runs.h"

/* scenes/NAME.yaml */
static inline Scene *scene_named(const char *name) {
    char path[512];
    Error error = {0};
    snprintf(path, sizeof path, SOURCE_DIR "/scenes/%s.yaml", name);
    Scene *scene = scene_read(path, &error);
    assert_ok(scene != NULL, error);
    return scene;
}

static inline Method method_named(const char *text) {
    Error error = {0};
    Method method;
    assert_ok(method_parse(&method, text, &error), error);
    return method;
}

static inline World *world_of(const Scene *scene) {
    Error error = {0};
    World *world = scene_world(scene, &error);
    assert_ok(world != NULL, error);
    return world;
}

static inline Stepper *stepper_of(const Scene *scene, const Method *method) {
    Error error = {0};
    Stepper *stepper = stepper_create(method, scene, &error);
    assert_ok(stepper != NULL, error);
    return stepper;
}

static inline Trajectory *run_by(const Scene *scene, const char *method_text) {
    Error error = {0};
    const Method method = method_named(method_text);
    Trajectory *run = simulate(scene, &method, NULL, &error);
    assert_ok(run != NULL, error);
    return run;
}

static inline Trajectory *trajectory_of(const char *path) {
    Error error = {0};
    Trajectory *run = trajectory_read(path, &error);
    assert_ok(run != NULL, error);
    return run;
}

/* Of the same frames and bodies, with the same bits. */
static inline void assert_same_run(const Trajectory *a, const Trajectory *b) {
    TrajectoryDifference difference;
    trajectory_compare(a, b, &difference);
    assert_true(difference.equal);
}
