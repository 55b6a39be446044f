/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "cli/stability_clip.h"

#include "cli/draw_panels.h"
#include "cli/stability_cell.h"
#include "common/file.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TITLE_SIZE = 320, NOTE_SIZE = 160 };

/* s that are shown after the frame that decided the verdict. */
static const double clip_after = 3;

/* Hz: a scene with more steps per second is thinned to this rate. */
static const double clip_rate = 60;

/* The runs of a clip: first the method that holds, if there is one. */
typedef struct Clip {
    const ClipOptions *options;
    const ClipMap *map;
    const MapCell *rows[2];
    int count;
    double dt; /* s */
    Panels panels;
} Clip;

static bool choose_rows(Clip *clip, const MapTable *table, Error *error) {
    StabilityCell cell;
    if (!stability_cell_parse(&cell, clip->options->cell, error)) return false;
    const MapCell *row = stability_cell_find(table, &cell, error);
    if (row == NULL) return false;
    if (row->verdict >= VERDICTS) return error_input(error, "--clip", "'%s' is not applicable", clip->options->cell);
    for (int i = 0; i < clip->options->map_count; i++)
        if (strcmp(clip->options->maps[i].name, row->map) == 0) clip->map = &clip->options->maps[i];
    if (clip->map == NULL) return error_input(error, "--clip", "map %s has no scene", row->map);
    const MapCell *holder = verdict_holds((Verdict)row->verdict) ? NULL : stability_cell_holder(table, row);
    if (holder != NULL) clip->rows[clip->count++] = holder;
    clip->rows[clip->count++] = row;
    return true;
}

static Scene *read_scene(const Clip *clip, Error *error) {
    SceneSetting settings[2] = {{.value = clip->rows[0]->x}, {.value = clip->rows[0]->y}};
    snprintf(settings[0].name, sizeof settings[0].name, "%s", clip->map->x_parameter);
    snprintf(settings[1].name, sizeof settings[1].name, "%s", clip->map->y_parameter);
    return scene_read_with(clip->map->scene, settings, 2, error);
}

/* After an explosion, states may become NaN or infinite in the seconds that follow: then these are left out. */
static bool run_row(Clip *clip, Scene *scene, const MapCell *row, int shown, Error *error) {
    char method[MAP_METHOD_SIZE];
    Error failure = {0};
    map_cell_method(method, row);
    int decided = isnan(row->frame) || row->frame < 1 ? shown : (int)row->frame;
    scene->frames = row->verdict == VERDICT_NON_FINITE && decided > 1 ? decided - 1 : shown;
    if (panels_add_run(&clip->panels, scene, method, clip->options->cell, &failure)) return true;
    if (row->verdict != VERDICT_EXPLODES || failure.kind != ERROR_INPUT || decided >= shown) {
        *error = failure;
        return false;
    }
    scene->frames = decided;
    return panels_add_run(&clip->panels, scene, method, clip->options->cell, error);
}

static bool run_all(Clip *clip, Error *error) {
    Scene *scene = read_scene(clip, error);
    if (scene == NULL) return false;
    const MapCell *own = clip->rows[clip->count - 1];
    double shown = (isnan(own->frame) ? scene->frames : own->frame) + ceil(clip_after / (double)scene->dt);
    clip->dt = (double)scene->dt;
    bool ok = true;
    for (int i = 0, frames = scene->frames; ok && i < clip->count; i++)
        ok = run_row(clip, scene, clip->rows[i], shown < frames ? (int)shown : frames, error);
    scene_destroy(scene);
    return ok;
}

static bool thin_out(Clip *clip, Error *error) {
    int every = (int)(1 / (clip_rate * clip->dt) + 0.01);
    for (int i = 0; every > 1 && i < clip->panels.count; i++) {
        Trajectory *thin = trajectory_every(clip->panels.runs[i], every, error);
        if (thin == NULL) return false;
        trajectory_destroy(clip->panels.runs[i]);
        clip->panels.runs[i] = thin;
    }
    return true;
}

/* "falls at 4.2 s (0.53 m, body 7)" */
static void describe(char note[NOTE_SIZE], const MapCell *row, double dt) {
    size_t used = (size_t)snprintf(note, NOTE_SIZE, "%s", verdict_words[row->verdict]);
    if (verdict_holds((Verdict)row->verdict) || isnan(row->frame)) return;
    used += (size_t)snprintf(note + used, NOTE_SIZE - used, " at %.2f s", row->frame * dt);
    if (isnan(row->value)) return;
    used += (size_t)snprintf(note + used, NOTE_SIZE - used, " (%.3g %s", row->value, row->unit);
    if (!isnan(row->body) && row->body >= 0)
        used += (size_t)snprintf(note + used, NOTE_SIZE - used, ", body %.0f", row->body);
    snprintf(note + used, NOTE_SIZE - used, ")");
}

static bool draw(Clip *clip, Error *error) {
    const MapCell *own = clip->rows[clip->count - 1];
    char name[MAP_CLIP_SIZE], folder[PATH_MAX], video[PATH_MAX], title[TITLE_SIZE];
    char notes[2][NOTE_SIZE];
    map_cell_clip(name, own);
    if (!file_path(folder, sizeof folder, error, "%s/%s", clip->options->folder, name) ||
        !file_path(video, sizeof video, error, "%s.mp4", folder))
        return false;
    snprintf(title, sizeof title, "%s %.4g %s, %s %.4g %s", own->x_parameter, own->x, own->x_unit, own->y_parameter,
             own->y, own->y_unit);
    RenderOptions render = draw_panels_defaults(folder);
    render.width = clip->options->width;
    render.height = clip->options->height;
    render.title = title;
    for (int i = 0; i < clip->count; i++) {
        describe(notes[i], clip->rows[i], clip->dt);
        render.notes[i] = notes[i];
    }
    const DrawVideos videos = {1, {video}};
    RenderResult result;
    if (!file_make_directory(folder, error) || !draw_videos_check(&videos, render.width, render.height, error) ||
        !draw_panels(&clip->panels, &render, &videos, &result, error))
        return false;
    printf("%s: %s -> %s, %s/frame_%06d.png ... frame_%06d.png\n", clip->options->cell, notes[clip->count - 1], video,
           folder, result.first, result.last);
    return true;
}

bool stability_clip(const ClipOptions *options, Error *error) {
    MapTable table;
    if (!map_table_read(&table, options->folder, error)) return false;
    Clip clip = {.options = options};
    bool ok =
        choose_rows(&clip, &table, error) && run_all(&clip, error) && thin_out(&clip, error) && draw(&clip, error);
    panels_free(&clip.panels);
    map_table_free(&table);
    return ok;
}
