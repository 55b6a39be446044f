/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The functions of the module that describe methods, scenes and verdicts, as JSON. */
#include "base/base.h"
#include "base/file.h"
#include "base/json_write.h"
#include "engine/engine.h"
#include "live/live_internal.h"
#include "live/live.h"
#include "methods/methods.h"
#include "runs/framing.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <stdio.h>
#include <stdlib.h>

/* Prints JSON into the text that was last returned. NULL when memory is short. */
static const char *print(void (*write)(JsonWriter *json, const void *context), const void *context) {
    static char *text;
    size_t size;
    free(text);
    text = NULL;
    FILE *out = memory_stream(&text, &size);
    if (out == NULL) {
        error_memory(live_new_error(), "text");
        return NULL;
    }
    JsonWriter json = {.out = out};
    write(&json, context);
    const bool ok = ferror(out) == 0;
    if (fclose(out) == 0 && ok) return text;
    error_memory(live_new_error(), "text");
    return NULL;
}

static void put_pair(JsonWriter *json, const char *key, double x, double y) {
    json_begin_array(json, key, JSON_ONE_LINE);
    json_put_number(json, NULL, x);
    json_put_number(json, NULL, y);
    json_end(json);
}

static void put_setting(JsonWriter *json, const SettingSpec *setting) {
    static const char *const types[] = {
        [SETTING_IS_OWN] = "text", [SETTING_IS_INT] = "int", [SETTING_IS_FLOAT] = "float", [SETTING_IS_BOOL] = "bool"};
    json_begin_object(json, NULL, JSON_ONE_LINE);
    json_put_text(json, "key", setting->key);
    json_put_text(json, "summary", setting->summary);
    json_put_text(json, "type", types[setting->type]);
    if (setting->type == SETTING_IS_INT || setting->type == SETTING_IS_FLOAT) {
        json_put_number(json, "from", setting->least);
        json_put_number(json, "to", setting->most);
    }
    json_end(json);
}

static void write_methods(JsonWriter *json, const void *context) {
    (void)context;
    json_begin_array(json, NULL, JSON_LINES);
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        const MethodDescription *method = kind->description;
        json_begin_object(json, NULL, JSON_LINES);
        json_put_text(json, "name", method->name);
        json_put_text(json, "summary", method->summary);
        json_put_text(json, "caption", method->caption);
        json_put_bool(json, "needs_network", method->needs_network);
        json_begin_array(json, "settings", JSON_LINES);
        for (const SettingSpec *setting = method->settings; setting != NULL && setting->key != NULL; setting++)
            put_setting(json, setting);
        json_end(json);
        json_end(json);
    }
    json_end(json);
}

const char *live_methods(void) { return print(write_methods, NULL); }

static void put_bomb(JsonWriter *json, const Scene *scene) {
    if (!scene_has_launch(scene)) {
        json_put_text(json, "bomb", NULL);
        return;
    }
    const BodyDef bomb = scene_bomb_body(scene);
    json_begin_object(json, "bomb", JSON_ONE_LINE);
    json_put_int(json, "frame", scene->bomb.frame);
    json_put_number(json, "x", (double)bomb.position.x);
    json_put_number(json, "y", (double)bomb.position.y);
    json_put_number(json, "mass", (double)bomb.mass);
    json_put_number(json, "speed", vec2_distance(bomb.velocity, vec2(0, 0)));
    put_pair(json, "velocity", (double)bomb.velocity.x, (double)bomb.velocity.y);
    put_pair(json, "size", (double)bomb.size.x, (double)bomb.size.y);
    put_pair(json, "reach", (double)scene->bomb.x.from, (double)scene->bomb.x.to);
    json_end(json);
}

static void write_scene(JsonWriter *json, const void *context) {
    const Scene *scene = context;
    const SceneParameters parameters = scene_parameters(scene);
    json_begin_object(json, NULL, JSON_LINES);
    json_put_text(json, "name", scene->name);
    json_put_number(json, "dt", (double)scene->dt);
    json_put_int(json, "steps", scene->frames);
    json_put_int(json, "iterations", scene->iterations);
    json_put_hash(json, "scene_hash", scene_hash(scene));
    json_put_int(json, "bodies", scene->body_count + scene_has_launch(scene));
    put_pair(json, "gravity", (double)scene->gravity.x, (double)scene->gravity.y);
    json_begin_object(json, "camera", JSON_ONE_LINE);
    put_pair(json, "center", (double)scene->camera_center.x, (double)scene->camera_center.y);
    put_pair(json, "size", (double)scene->camera_size.x, (double)scene->camera_size.y);
    json_end(json);
    put_bomb(json, scene);
    json_begin_array(json, "parameters", JSON_LINES);
    for (const SceneParameter *parameter = parameters.items; parameter < parameters.items + parameters.count;
         parameter++) {
        json_begin_object(json, NULL, JSON_ONE_LINE);
        json_put_text(json, "name", parameter->name);
        json_put_text(json, "unit", parameter->unit);
        json_put_number(json, "value", parameter->value);
        json_put_number(json, "from", parameter->from);
        json_put_number(json, "to", parameter->to);
        json_put_bool(json, "whole", parameter->whole);
        json_put_bool(json, "common", parameter->common);
        json_end(json);
    }
    json_end(json);
    json_end(json);
}

const char *live_describe(LiveScene *live, const char *settings) {
    Scene *scene = live_scene(live, settings, live_new_error());
    const char *text = scene != NULL ? print(write_scene, scene) : NULL;
    scene_destroy(scene);
    return text;
}

static void write_verdict(JsonWriter *json, const void *context) {
    const SimulateVerdict *verdict = context;
    char words[TRAJECTORY_VERDICT_SIZE];
    simulate_verdict_words(verdict, words);
    json_begin_object(json, NULL, JSON_LINES);
    json_put_text(json, "verdict", verdict_name(verdict->reading.verdict));
    json_put_int(json, "frame", verdict->reading.frame);
    json_put_int(json, "body", verdict->reading.body);
    json_put_text(json, "words", words);
    json_end(json);
}

const char *live_verdict(const LiveRun *run) {
    SimulateVerdict verdict;
    return live_verdict_of(run, &verdict) ? print(write_verdict, &verdict) : NULL;
}

static void write_framing(JsonWriter *json, const void *context) {
    const Trajectory *run = context;
    const CameraFrame frame = camera_frame(&run, 1);
    camera_frame_put(json, NULL, &frame);
}

const char *live_framing(const LiveRun *run) { return print(write_framing, live_trajectory(run)); }
