/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view in manifest.json: what is where in the pictures. Rectangles are [x, y, width, height] in pixels, y down.

   "view": {
     "panels": [
       {"rectangle": [46, 61, 570, 614], "runs": ["stack-engine.npz"], "scale": 36, "left": 195, "top": 596}, ...
     ],
     "parts": [
       {"part": "header", "rectangle": [0, 0, 1280, 49]},
       {"part": "caption", "panel": 0, "rectangle": [46, 34, 570, 26]}, ...
     ]
   }

   The point (X, Y) in metres is at pixel (x + left + scale * X, y + top - scale * Y) of the picture. `runs` are the files
   beside the manifest (trajectory_file_name): the first with filled boxes, the others as outlines. Parts are header,
   caption, axis, legend and timeline. With a moving camera, each picture has its own scale, left and top as "camera". */
#include "base/json.h"
#include "pictures/internal.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "pictures/render_internal.h"
#include "pixels/gl.h"
#include "runs/trajectory.h"

#include <stddef.h>
#include <stdlib.h>

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
static void manifest_view_write_runs(JsonWriter *json, const Picture *picture, int panel) {
    const int filled = picture_run(picture, panel);
    json_begin_array(json, "runs", JSON_ONE_LINE);
    write_run(json, picture, filled);
    for (int run = 0; run < picture->count; run++)
        if (picture_draws_outlines(picture, panel, run)) write_run(json, picture, run);
    json_end(json);
}

/* The members scale, left and top. */
static void manifest_write_camera(JsonWriter *json, const Camera *camera) {
    json_put_number(json, "scale", camera->scale);
    json_put_number(json, "left", camera->left);
    json_put_number(json, "top", camera->top);
}

static void write_panels(JsonWriter *json, const Picture *picture) {
    json_begin_array(json, "panels", JSON_LINES);
    for (int panel = 0; panel < picture->panel_count; panel++) {
        json_begin_object(json, NULL, JSON_ONE_LINE);
        write_rectangle(json, &picture->layout.panels[panel]);
        manifest_view_write_runs(json, picture, panel);
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

static void manifest_write_view(JsonWriter *json, const Picture *picture) {
    json_begin_object(json, "view", JSON_LINES);
    write_panels(json, picture);
    write_parts(json, picture);
    json_end(json);
}

/* The content of the manifest. */

enum { FORMAT = 1 };

static void write_runs(JsonWriter *json, const Manifest *manifest) {
    json_begin_array(json, "runs", JSON_LINES);
    for (int i = 0; i < manifest->picture->count; i++) {
        const Trajectory *run = manifest->picture->runs[i];
        json_begin_object(json, NULL, JSON_ONE_LINE);
        json_put_text(json, "scene", run->scene);
        json_put_hash(json, "scene_hash", run->scene_hash);
        json_put_text(json, "method", run->method);
        json_put_text(json, "caption", manifest->options->captions[i]);
        json_put_text(json, "note", manifest->options->notes[i]);
        json_put_text(json, "cost", manifest->options->look.costs[i]);
        json_put_int(json, "frames", run->frames);
        json_put_int(json, "bomb", run->bomb);
        json_put_hash(json, "hash", trajectory_hash(run));
        json_end(json);
    }
    json_end(json);
}

static void write_look(JsonWriter *json, const RenderLook *look) {
    json_begin_object(json, "look", JSON_LINES);
    json_put_text(json, "compare", look_compare_names[look->compare]);
    json_put_text(json, "camera", look_camera_names[look->camera]);
    json_put_text(json, "theme", look_theme_names[look->theme]);
    json_begin_array(json, "show", JSON_ONE_LINE);
    for (int i = 0; look_show_names[i] != NULL; i++)
        if (look->show >> i & 1) json_put_text(json, NULL, look_show_names[i]);
    json_end(json);
    json_end(json);
}

/* The range of frames, and the number of pictures of everything else. */
static void write_order(JsonWriter *json, const Manifest *manifest) {
    const MomentPlan *plan = manifest->plan;
    json_begin_object(json, "order", JSON_LINES);
    json_put_int(json, "first", plan->first);
    json_put_int(json, "last", plan->last);
    json_put_int(json, "title_card", plan->title);
    json_begin_object(json, "slow", JSON_ONE_LINE);
    json_put_int(json, "times", plan->slow);
    json_put_int(json, "first", plan->slow_first);
    json_put_int(json, "last", plan->slow_last);
    json_end(json);
    json_put_number(json, "rate", plan->rate);
    json_put_number(json, "speed", plan->speed);
    json_put_int(json, "hold", plan->hold);
    json_put_int(json, "end_card", plan->end);
    json_end(json);
}

static void write_head(JsonWriter *json, const Manifest *manifest) {
    const RenderOptions *options = manifest->options;
    json_begin_object(json, NULL, JSON_LINES);
    json_put_text(json, "twinbox", TWINBOX_VERSION);
    json_put_int(json, "format", FORMAT);
    json_begin_array(json, "size", JSON_ONE_LINE);
    json_put_int(json, NULL, options->width);
    json_put_int(json, NULL, options->height);
    json_end(json);
    json_put_number(json, "dt", (double)manifest->picture->runs[0]->dt);
    json_put_text(json, "png", options->small ? "small" : "fast");
    json_put_text(json, "title", options->title);
    json_put_text(json, "end", options->look.end);
    write_runs(json, manifest);
    write_look(json, &options->look);
    write_order(json, manifest);
    manifest_write_view(json, manifest->picture);
    json_begin_array(json, "pictures", JSON_LINES);
}

static void write_moving_camera(JsonWriter *json, const Picture *picture, Moment moment) {
    const Camera camera = picture_camera(picture, moment);
    json_begin_object(json, "camera", JSON_ONE_LINE);
    manifest_write_camera(json, &camera);
    json_end(json);
}

static void write_picture(JsonWriter *json, const Manifest *manifest, int index, PictureHashes hashes) {
    static const char *const kinds[] = {"frame", "between", "title", "end"};
    const Picture *picture = manifest->picture;
    Moment moment = moments_at(manifest->plan, index);
    char text[SINK_NAME_SIZE];
    sink_frame_name(text, index);
    json_begin_object(json, NULL, JSON_ONE_LINE);
    json_put_text(json, "file", text);
    json_put_text(json, "shows", kinds[moment.kind]);
    json_put_int(json, "frame", moment.frame);
    frame_part_text(text, sizeof text, moment);
    if (moment.kind == MOMENT_BETWEEN) json_put_text(json, "part", text);
    if (picture->path != NULL && (moment.kind == MOMENT_STORED || moment.kind == MOMENT_BETWEEN))
        write_moving_camera(json, picture, moment);
    json_begin_array(json, "states", JSON_ONE_LINE);
    for (int i = 0; i < picture->count; i++)
        json_put_hash(json, NULL, trajectory_frame_hash(picture->runs[i], picture_run_frame(picture, i, moment.frame)));
    json_end(json);
    json_put_hash(json, "pixels", hashes.pixels);
    json_put_hash(json, "file_hash", hashes.file);
    json_end(json);
}

void manifest_print_head(FILE *out, const void *manifest) {
    JsonWriter json = {.out = out};
    write_head(&json, manifest);
}

void manifest_print_line(FILE *out, const void *context) {
    const ManifestLine *line = context;
    JsonWriter json = {.out = out};
    write_picture(&json, line->manifest, line->index, line->hashes);
}

void manifest_print_journal(FILE *out, const void *context) {
    const Manifest *manifest = context;
    fprintf(out, "%s\n", manifest->head);
    for (int i = manifest->first; i <= manifest->last; i++)
        if (manifest->known[i - manifest->first])
            manifest_print_line(out, &(ManifestLine){manifest, i, manifest->hashes[i - manifest->first]});
}

void manifest_print_whole(FILE *out, const void *context) {
    const Manifest *manifest = context;
    JsonWriter json = {.out = out};
    write_head(&json, manifest);
    for (int i = manifest->first; i <= manifest->last; i++)
        write_picture(&json, manifest, i, manifest->hashes[i - manifest->first]);
    json_end(&json);
    json_end(&json);
}
