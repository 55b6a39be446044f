/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The content of the manifest. */
#include "render/manifest_print.h"

#include "common/file.h"
#include "common/json_write.h"
#include "render/frame_texts.h"
#include "render/manifest_view.h"
#include "render/sink.h"

#include <stdlib.h>

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
