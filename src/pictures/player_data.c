/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where runs part from the first one. */
#include "base/base.h"
#include "base/json.h"
#include "methods/methods.h"
#include "pictures/internal.h"
#include "pictures/picture.h"
#include "pictures/player_internal.h"
#include "pixels/gl.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double POINT = 2e-3; /* of a box: a tenth of a pixel where a box has 50 */
static const double SMALL = 1e-2; /* of common impulses: shorter arrows cannot be seen */

typedef bool IsThere(const Trajectory *first, const Trajectory *run, int frame, int body);

static bool differs(const Trajectory *first, const Trajectory *run, int frame, int body) {
    return !trajectory_same_state(first, run, frame, body);
}

static bool is_apart(const Trajectory *first, const Trajectory *run, int frame, int body) {
    return trajectory_has(first, frame, body) && trajectory_has(run, frame, body) &&
           trajectory_state_difference(first, run, frame, body).distance > EVENTS_VISIBLE_DISTANCE;
}

/* The first frame and body for which it holds; -1, -1: none. */
static void find(const Trajectory *first, const Trajectory *run, IsThere *is_there, int *frame, int *body) {
    const int frames = first->frames < run->frames ? first->frames : run->frames;
    for (*frame = 0; *frame < frames; ++*frame)
        for (*body = 0; *body < run->bodies; ++*body)
            if (is_there(first, run, *frame, *body)) return;
    *frame = *body = -1;
}

static void find_marks(Player *player, int index) {
    const Trajectory *first = player->picture.runs[0], *trajectory = player->picture.runs[index];
    PlayerRun *run = &player->runs[index];
    run->frames = player_frame_count(&player->frames, trajectory->frames);
    run->chunks = (run->frames + PLAYER_CHUNK - 1) / PLAYER_CHUNK;
    run->differs_frame = run->apart_frame = -1;
    run->compared = index == 0 || !trajectory_different_worlds(first, trajectory, run->why, sizeof run->why);
    if (index == 0 || !run->compared) return;
    find(first, trajectory, differs, &run->differs_frame, &run->differs_body);
    find(first, trajectory, is_apart, &run->apart_frame, &run->apart_body);
    run->differs_frame = player_stored(&player->frames, run->differs_frame);
    run->apart_frame = player_stored(&player->frames, run->apart_frame);
}

static bool measure_frames(Player *player, int index, Error *error) {
    PlayerRun *run = &player->runs[index];
    run->hashes = malloc((size_t)run->frames * sizeof *run->hashes);
    run->distances = malloc((size_t)run->frames * sizeof *run->distances);
    if (run->hashes == NULL || run->distances == NULL) return error_memory(error, "page");
    for (int i = 0; i < run->frames; i++) {
        const int frame = player_frame(&player->frames, i);
        run->hashes[i] = trajectory_frame_hash(player->picture.runs[index], frame);
        run->distances[i] =
            run->compared ? (float)picture_run_distance(&player->picture, index, moment_stored(frame)) : NAN;
    }
    return true;
}

bool player_find_marks(Player *player, Error *error) {
    for (int i = 0; i < player->picture.count; i++) find_marks(player, i);
    const double impulse = SMALL * player->measures.impulse;
    player->units = (ContactUnits){(float)(POINT * player->measures.box), impulse > 0 ? (float)impulse : 1};
    for (int i = 0; i < player->picture.count; i++) {
        if (player->runs[i].frames == 0)
            return error_input(error, "--frames", "run %d (%s) ends before frame %d", i + 1,
                               player->picture.runs[i]->method, player->frames.first);
        if (!measure_frames(player, i, error)) return false;
    }
    return true;
}

enum {
    RAMP = 11, /* colours of the scale of distances */
    EM = 40    /* pixels: large, as widths are whole pixels */
};

static void put_color(JsonWriter *json, const char *key, uint32_t color) {
    char text[16];
    snprintf(text, sizeof text, "#%06x", color);
    json_put_text(json, key, text);
}

static void put_body_colors(JsonWriter *json, const char *key, const BodyColors *colors) {
    json_begin_object(json, key, JSON_ONE_LINE);
    put_color(json, "fill", colors->fill);
    put_color(json, "line", colors->line);
    put_color(json, "band", colors->band);
    json_end(json);
}

static void put_theme(JsonWriter *json, const char *key, const Theme *theme) {
    json_begin_object(json, key, JSON_LINES);
    put_color(json, "page", theme->page);
    put_color(json, "panel", theme->panel);
    put_color(json, "frame", theme->frame);
    put_color(json, "grid", theme->grid);
    put_color(json, "grid_strong", theme->grid_strong);
    put_color(json, "ink", theme->ink);
    put_color(json, "ink_soft", theme->ink_soft);
    put_color(json, "ground", theme->ground);
    put_color(json, "ground_line", theme->ground_line);
    put_color(json, "impulse", theme->impulse);
    put_color(json, "velocity", theme->velocity);
    put_color(json, "event", theme->event);
    put_body_colors(json, "bomb", &theme->bomb);
    json_put_bool(json, "ghost_is_band", theme->ghost_is_band);
    json_begin_array(json, "ramp", JSON_ONE_LINE);
    for (int i = 0; i < RAMP; i++) put_color(json, NULL, theme_ramp(theme, i / (RAMP - 1.0)));
    json_end(json);
    json_end(json);
}

static void put_mark(JsonWriter *json, const char *key, int frame, int body) {
    if (frame < 0) {
        json_put_text(json, key, NULL);
        return;
    }
    json_begin_object(json, key, JSON_ONE_LINE);
    json_put_int(json, "frame", frame);
    json_put_int(json, "body", body);
    json_end(json);
}

/* Width of text in ems of the built-in font. Grids of panels depend on it: not on the reader's fonts. */
static double ems(FontFace face, const char *text) {
    const Font font = font_pick(face, EM);
    return (double)font_width(&font, text) / font.pixels;
}

static void put_provenance(JsonWriter *json, const Player *player, int index) {
    const Trajectory *run = player->picture.runs[index];
    char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
    caption_method(&player->picture, index, name, note);
    if (player->options->names[index] != NULL) method_name(note, sizeof note, run->method);
    json_put_text(json, "scene", run->scene);
    json_put_text(json, "method", run->method);
    json_put_text(json, "name", name);
    json_put_text(json, "note", note);
    json_put_number(json, "ems", ems(FONT_SEMIBOLD, name));
    json_put_text(json, "file", player->options->files[index]);
    json_put_hash(json, "hash", trajectory_hash(run));
    if (run->scene_hash != 0)
        json_put_hash(json, "scene_hash", run->scene_hash);
    else
        json_put_text(json, "scene_hash", "");
    json_put_int(json, "iterations", run->iterations);
    json_put_number(json, "dt", (double)run->dt);
    json_put_int(json, "steps", run->frames - 1);
}

static void put_verdict(JsonWriter *json, const Player *player, const Trajectory *run) {
    if (run->verdict[0] == '\0') {
        json_put_text(json, "verdict", NULL);
        return;
    }
    json_begin_object(json, "verdict", JSON_ONE_LINE);
    json_put_text(json, "text", run->verdict);
    json_put_int(json, "frame", player_stored(&player->frames, run->verdict_frame));
    json_put_int(json, "body", run->verdict_body);
    json_end(json);
}

static void put_run(JsonWriter *json, const Player *player, int index) {
    const Trajectory *trajectory = player->picture.runs[index];
    const PlayerRun *run = &player->runs[index];
    json_begin_object(json, NULL, JSON_LINES);
    put_provenance(json, player, index);
    json_put_int(json, "bodies", trajectory->bodies);
    json_put_int(json, "bomb", trajectory->bomb);
    json_put_int(json, "frames", run->frames);
    json_put_int(json, "chunks", run->chunks);
    json_put_bool(json, "velocities", !trajectory->no_velocities);
    json_put_bool(json, "contacts", run->contacts != NULL);
    json_begin_object(json, "colours", JSON_ONE_LINE);
    put_body_colors(json, "light", &theme_get(LOOK_LIGHT)->bodies[player->picture.colours[index]]);
    put_body_colors(json, "dark", &theme_get(LOOK_DARK)->bodies[player->picture.colours[index]]);
    json_end(json);
    put_verdict(json, player, trajectory);
    json_put_bool(json, "compared", run->compared);
    json_put_text(json, "why", run->why);
    put_mark(json, "differs", run->differs_frame, run->differs_body);
    put_mark(json, "apart", run->apart_frame, run->apart_body);
    json_end(json);
}

static void put_left_out(JsonWriter *json, const Player *player) {
    const PlayerFrames *frames = &player->frames;
    char text[96];
    json_begin_array(json, "left_out", JSON_ONE_LINE);
    if (frames->first > 0 || frames->last < player->picture.frames - 1) {
        snprintf(text, sizeof text, "only frames %d to %d of %d", frames->first, frames->last, player->picture.frames);
        json_put_text(json, NULL, text);
    }
    if (frames->every > 1) {
        snprintf(text, sizeof text, "only one frame in %d", frames->every);
        json_put_text(json, NULL, text);
    }
    if (player->left_contacts) json_put_text(json, NULL, "without contacts, which would make the page too large");
    json_end(json);
}

static void put_framing(JsonWriter *json, const Trajectory *run) {
    const CameraFrame frame = camera_frame(run);
    json_begin_object(json, "framing", JSON_ONE_LINE);
    json_put_bool(json, "set", frame.set);
    json_put_number(json, "left", frame.left);
    json_put_number(json, "right", frame.right);
    json_put_number(json, "bottom", frame.bottom);
    json_put_number(json, "top", frame.top);
    json_put_number(json, "middle", frame.middle);
    json_end(json);
}

static void put_measures(JsonWriter *json, const Player *player) {
    json_begin_object(json, "scales", JSON_ONE_LINE);
    json_put_number(json, "impulse", player->measures.impulse);
    json_put_number(json, "speed", player->measures.speed);
    json_put_number(json, "box", player->measures.box);
    json_put_number(json, "largest", player->picture.largest_distance);
    json_end(json);
    json_begin_object(json, "units", JSON_ONE_LINE);
    json_put_number(json, "length", (double)player->units.length);
    json_put_number(json, "impulse", (double)player->units.impulse);
    json_end(json);
}

static int first_impact(const Picture *picture) {
    for (int i = 0; i < picture->count; i++) {
        const int impact = trajectory_impact(picture->runs[i]);
        if (impact >= 0) return impact;
    }
    return -1;
}

void player_put_data(FILE *file, const Player *player) {
    JsonWriter json = {.out = file};
    const Trajectory *first = player->picture.runs[0];
    char title[CAPTION_TEXT_SIZE];
    caption_title(&player->picture, title);
    json_begin_object(&json, NULL, JSON_LINES);
    json_put_text(&json, "version", TWINBOX_VERSION);
    json_put_text(&json, "title", title);
    json_put_number(&json, "dt", (double)player_dt(&player->frames, first));
    json_put_int(&json, "every", player->frames.every);
    json_put_int(&json, "first", player->frames.first);
    json_put_int(&json, "frames", player_frame_count(&player->frames, player->picture.frames));
    json_put_int(&json, "total", player->picture.frames);
    json_put_int(&json, "chunk", PLAYER_CHUNK);
    json_put_int(&json, "impact", player_stored(&player->frames, first_impact(&player->picture)));
    json_put_number(&json, "distance_ems", ems(FONT_REGULAR, "0.00 m"));
    put_left_out(&json, player);
    put_framing(&json, first);
    put_measures(&json, player);
    json_begin_object(&json, "themes", JSON_LINES);
    put_theme(&json, "light", theme_get(LOOK_LIGHT));
    put_theme(&json, "dark", theme_get(LOOK_DARK));
    json_end(&json);
    json_begin_array(&json, "runs", JSON_LINES);
    for (int i = 0; i < player->picture.count; i++) put_run(&json, player, i);
    json_end(&json);
    json_end(&json);
}
