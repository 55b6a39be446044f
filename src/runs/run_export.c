/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a run, or a scene with all its numbers, as JSON. */
#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "engine/engine.h"
#include "runs/run_files.h"
#include "runs/trajectory.h"
#include "scenes/scenes.h"

#include <stdlib.h>

/* Nine digits are enough for a float; all digits of its double would be twice as long. */
static void put_float(JsonWriter *json, const char *key, float value) {
    char digits[32];
    snprintf(digits, sizeof digits, "%.9g", (double)value);
    json_put_number(json, key, strtod(digits, NULL));
}

static void put_vector(JsonWriter *json, const char *key, Vec2 v) {
    json_begin_array(json, key, JSON_ONE_LINE);
    put_float(json, NULL, v.x);
    put_float(json, NULL, v.y);
    json_end(json);
}

static void put_head(JsonWriter *json, const Trajectory *run) {
    json_put_text(json, "format", "twinbox run");
    json_put_int(json, "version", TRAJECTORY_VERSION);
    json_put_text(json, "scene", run->scene);
    json_put_text(json, "method", run->method);
    if (run->program[0] != '\0') json_put_text(json, "program", run->program);
    if (run->network_hash != 0) json_put_hash(json, "network_hash", run->network_hash);
    if (run->scene_hash != 0) json_put_hash(json, "scene_hash", run->scene_hash);
    put_float(json, "dt", run->dt);
    if (run->bomb >= 0) json_put_int(json, "bomb", run->bomb);
    if (run->camera_size.x > 0 && run->camera_size.y > 0) {
        put_vector(json, "camera_centre", run->camera_center);
        put_vector(json, "camera_size", run->camera_size);
    }
}

/* [x, y, angle, vx, vy, omega] */
static void put_state(JsonWriter *json, const Trajectory *run, int frame, int body) {
    const size_t i = trajectory_at(run, frame, body);
    if (json_put_absent(json, NULL, !trajectory_has(run, frame, body))) return;
    json_begin_array(json, NULL, JSON_ONE_LINE);
    for (int column = 0; column < (run->no_velocities ? 3 : STATE_COLUMNS); column++) {
        const double number = trajectory_number(run, i, column);
        run->exact != NULL ? json_put_number(json, NULL, number) : put_float(json, NULL, (float)number);
    }
    json_end(json);
}

static void put_contacts(JsonWriter *json, const Trajectory *run, int frame) {
    json_begin_array(json, "contacts", JSON_ONE_LINE);
    for (int64_t i = run->contact_start[frame]; i < run->contact_start[frame + 1]; i++) {
        const TrajectoryContact *contact = &run->contacts[i];
        json_begin_object(json, NULL, JSON_ONE_LINE);
        json_put_int(json, "a", contact->a);
        json_put_int(json, "b", contact->b);
        put_vector(json, "point", contact->point);
        put_vector(json, "normal", contact->normal);
        put_vector(json, "impulse", vec2(contact->normal_impulse, contact->tangent_impulse));
        json_end(json);
    }
    json_end(json);
}

static void json_run_print(FILE *out, const void *context) {
    const Trajectory *run = context;
    JsonWriter json = {.out = out};
    json_begin_object(&json, NULL, JSON_LINES);
    put_head(&json, run);
    json_begin_array(&json, "bodies", JSON_LINES);
    for (int body = 0; body < run->bodies; body++) {
        json_begin_object(&json, NULL, JSON_ONE_LINE);
        put_vector(&json, "size", run->size[body]);
        json_put_bool(&json, "static", run->fixed[body]);
        json_end(&json);
    }
    json_end(&json);
    json_begin_array(&json, "frames", JSON_LINES);
    for (int frame = 0; frame < run->frames; frame++) {
        json_begin_object(&json, NULL, JSON_ONE_LINE);
        json_begin_array(&json, "states", JSON_ONE_LINE);
        for (int body = 0; body < run->bodies; body++) put_state(&json, run, frame, body);
        json_end(&json);
        if (!run->no_contacts) put_contacts(&json, run, frame);
        json_end(&json);
    }
    json_end(&json);
    json_end(&json);
}

bool json_run_write(const Trajectory *run, const char *path, Error *error) {
    return file_write_text(path, json_run_print, run, error);
}

static void put_body(JsonWriter *json, const char *key, const BodyDef *body, int frame) {
    json_begin_object(json, key, JSON_ONE_LINE);
    if (frame >= 0) json_put_int(json, "frame", frame);
    json_put_bool(json, "static", body->fixed);
    put_vector(json, "size", body->size);
    put_vector(json, "position", body->position);
    put_float(json, "angle", body->angle);
    put_vector(json, "velocity", body->velocity);
    put_float(json, "angular_velocity", body->angular_velocity);
    put_float(json, "mass", body->fixed ? 0 : body->mass);
    put_float(json, "friction", body->friction);
    json_end(json);
}

static void scene_flat_print(FILE *out, const void *context) {
    const Scene *scene = context;
    JsonWriter json = {.out = out};
    json_begin_object(&json, NULL, JSON_LINES);
    json_put_text(&json, "format", "twinbox scene");
    json_put_int(&json, "version", 1);
    json_put_text(&json, "scene", scene->name);
    json_put_hash(&json, "scene_hash", scene_hash(scene));
    put_vector(&json, "gravity", scene->gravity);
    put_float(&json, "dt", scene->dt);
    json_put_int(&json, "frames", scene->frames);
    json_put_int(&json, "iterations", scene->iterations);
    if (scene->last_body_until > 0) json_put_int(&json, "last_body_until", scene->last_body_until);
    json_begin_array(&json, "bodies", JSON_LINES);
    for (int i = 0; i < scene->body_count; i++) put_body(&json, NULL, &scene->bodies[i], -1);
    json_end(&json);
    const BodyDef bomb = scene->bomb.present ? scene_bomb_body(scene) : (BodyDef){.fixed = true};
    if (scene->bomb.present) put_body(&json, "bomb", &bomb, scene->bomb.frame);
    json_end(&json);
}

bool scene_flat_write(const Scene *scene, const char *path, Error *error) {
    return file_write_text(path, scene_flat_print, scene, error);
}
