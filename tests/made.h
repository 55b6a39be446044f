/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes, methods, steppers, runs, networks and pictures that must be in order. */
#pragma once
#include "owned.h"

#include "base/npz.h"
#include "nets/nets.h"
#include "pixels/png.h"
#include "runs/compare_runs.h"
#include "runs/runs.h"
#include "runs/runs_internal.h"
#include "runs/trajectory.h"

/* Appends a contact of a step. */
static inline void add_contact(Trajectory *run, int step, TrajectoryContact contact) {
    Error error = {0};
    TrajectoryContact *added = trajectory_add_contacts(run, step, 1, &error);
    assert_ok(added != NULL, error);
    *added = contact;
}

static inline Scene *scene_from(const char *path) {
    Error error = {0};
    Scene *scene = scene_read(path, &error);
    assert_ok(scene != NULL, error);
    return scene;
}

/* scenes/NAME.yaml */
static inline Scene *scene_named(const char *name) {
    char path[512];
    snprintf(path, sizeof path, SOURCE_DIR "/scenes/%s.yaml", name);
    return scene_from(path);
}

/* Of these bodies, as shipped scenes are: 10 m/s^2, 60 Hz, 10 iterations. */
static inline Scene scene_of_bodies(BodyDef *bodies, int count, int frames) {
    return (Scene){.name = "by hand",
                   .gravity = {0, -10},
                   .dt = 1.0f / 60.0f,
                   .iterations = 10,
                   .warm_starting = true,
                   .accumulate_impulses = true,
                   .position_correction = true,
                   .frames = frames,
                   .body_count = count,
                   .bodies = bodies};
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

static inline Stepper *stepper_by(const Scene *scene, const char *method_text) {
    const Method method = method_named(method_text);
    return stepper_of(scene, &method);
}

static inline Trajectory *run_with(const Scene *scene, const Method *method) {
    Error error = {0};
    Trajectory *run = simulate(scene, method, NULL, &error);
    assert_ok(run != NULL, error);
    return run;
}

static inline Trajectory *run_by(const Scene *scene, const char *method_text) {
    const Method method = method_named(method_text);
    return run_with(scene, &method);
}

static inline Trajectory *run_sized(int frames, int bodies) {
    Error error = {0};
    Trajectory *run = trajectory_create(frames, bodies, &error);
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

static inline Network *network_sized(int layers, const int *widths) {
    Error error = {0};
    Network *network = network_create(layers, widths, &error);
    assert_ok(network != NULL, error);
    return network;
}

static inline NpzFile *npz_of(const char *path) {
    Error error = {0};
    NpzFile *file = npz_open(path, &error);
    assert_ok(file != NULL, error);
    return file;
}

static inline Image *image_sized(int width, int height) {
    Error error = {0};
    Image *image = image_create(width, height, &error);
    assert_ok(image != NULL, error);
    return image;
}

static inline Image *image_of(const char *path) {
    Error error = {0};
    Image *image = image_read_png(path, &error);
    assert_ok(image != NULL, error);
    return image;
}

/* Empty: the file has no such text. */
static inline void text_of_image(const char *path, const char *key, char *value, size_t size) {
    Error error = {0};
    size_t bytes;
    uint8_t *data = image_load_png(path, &bytes, &error);
    assert_ok(data != NULL && image_find_text(data, bytes, key, value, size, &error), error);
    free(data);
}

/* A run as trajectory_write() would, in any format. */
static inline bool write_as(const Trajectory *run, TrajectoryFormat format, const char *path, Error *error) {
    TrajectoryStream *stream = trajectory_stream_create(run, run->frames, format, path, error);
    const bool done =
        stream != NULL && trajectory_stream_add(stream, run, error) && trajectory_stream_finish(stream, error);
    trajectory_stream_destroy(stream);
    return done;
}
