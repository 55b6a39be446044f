/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/manifest_view.h"

#include "picture/parts.h"
#include "trajectory/trajectory_name.h"

#include <stddef.h>

static void write_rectangle(JsonWriter *json, const Rect *rect) {
    json_begin_array(json, "rectangle", JSON_ONE_LINE);
    json_put_int(json, NULL, rect->left);
    json_put_int(json, NULL, rect->top);
    json_put_int(json, NULL, rect->right - rect->left);
    json_put_int(json, NULL, rect->bottom - rect->top);
    json_end(json);
}

static void write_run(JsonWriter *json, const Picture *picture, int run) {
    char name[TRAJECTORY_FILE_NAME_SIZE];
    trajectory_file_name(picture->runs, run, name);
    json_put_text(json, NULL, name);
}

/* The run of the filled boxes first. */
static void write_runs(JsonWriter *json, const Picture *picture, int panel) {
    const int filled = picture_run(picture, panel);
    json_begin_array(json, "runs", JSON_ONE_LINE);
    write_run(json, picture, filled);
    for (int run = 0; run < picture->count; run++)
        if (picture_draws_outlines(picture, panel, run)) write_run(json, picture, run);
    json_end(json);
}

void manifest_write_camera(JsonWriter *json, const Camera *camera) {
    json_put_number(json, "scale", camera->scale);
    json_put_number(json, "left", camera->left);
    json_put_number(json, "top", camera->top);
}

static void write_panels(JsonWriter *json, const Picture *picture) {
    json_begin_array(json, "panels", JSON_LINES);
    for (int panel = 0; panel < picture->panel_count; panel++) {
        json_begin_object(json, NULL, JSON_ONE_LINE);
        write_rectangle(json, &picture->layout.panels[panel]);
        write_runs(json, picture, panel);
        manifest_write_camera(json, &picture->camera);
        json_end(json);
    }
    json_end(json);
}

static void write_parts(JsonWriter *json, const Picture *picture) {
    Part parts[PARTS_MAX];
    const int count = parts_find(picture, parts);
    json_begin_array(json, "parts", JSON_LINES);
    for (int i = 0; i < count; i++) {
        json_begin_object(json, NULL, JSON_ONE_LINE);
        json_put_text(json, "part", part_names[parts[i].kind]);
        if (parts[i].panel >= 0) json_put_int(json, "panel", parts[i].panel);
        write_rectangle(json, &parts[i].rect);
        json_end(json);
    }
    json_end(json);
}

void manifest_write_view(JsonWriter *json, const Picture *picture) {
    json_begin_object(json, "view", JSON_LINES);
    write_panels(json, picture);
    write_parts(json, picture);
    json_end(json);
}
