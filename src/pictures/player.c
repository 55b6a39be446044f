/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page that plays runs: where they part, the data that its script reads, the page itself. player_pack.c packs states
   and contacts. */
#include "pictures/player.h"

#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "methods/methods.h"
#include "methods/names.h"
#include "pictures/pictures_internal.h"
#include "pictures/page.h"
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

static bool player_differs(const Trajectory *first, const Trajectory *run, int frame, int body) {
    return !trajectory_same_state(first, run, frame, body);
}

static bool is_apart(const Trajectory *first, const Trajectory *run, int frame, int body) {
    return trajectory_has(first, frame, body) && trajectory_has(run, frame, body) &&
           trajectory_state_difference(first, run, frame, body).distance > EVENTS_VISIBLE_DISTANCE;
}

/* The first frame and body for which it holds; -1, -1: none. */
static void player_find(const Trajectory *first, const Trajectory *run, IsThere *is_there, int *frame, int *body) {
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
    run->chunks = player_run_is_live(player, index) ? 0 : (run->frames + PLAYER_CHUNK - 1) / PLAYER_CHUNK;
    run->differs_frame = run->apart_frame = -1;
    run->compared = index == 0 || !trajectory_different_worlds(first, trajectory, run->why, sizeof run->why);
    if (index == 0 || !run->compared) return;
    player_find(first, trajectory, player_differs, &run->differs_frame, &run->differs_body);
    player_find(first, trajectory, is_apart, &run->apart_frame, &run->apart_body);
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

/* Finds what a reader looks for: where runs part, distances, hashes. */
static bool find_all_marks(Player *player, Error *error) {
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
    EM = 40 /* pixels: large, as widths are whole pixels */
};

static void put_body_colors(JsonWriter *json, const char *key, const BodyColors *colors) {
    json_begin_object(json, key, JSON_ONE_LINE);
    colour_put(json, "fill", colors->fill);
    colour_put(json, "line", colors->line);
    colour_put(json, "band", colors->band);
    json_end(json);
}

static void put_theme(JsonWriter *json, const char *key, const Theme *theme) {
    json_begin_object(json, key, JSON_LINES);
    colour_put(json, "page", theme->page);
    colour_put(json, "panel", theme->panel);
    colour_put(json, "frame", theme->frame);
    colour_put(json, "grid", theme->grid);
    colour_put(json, "grid_strong", theme->grid_strong);
    colour_put(json, "ink", theme->ink);
    colour_put(json, "ink_soft", theme->ink_soft);
    colour_put(json, "ground", theme->ground);
    colour_put(json, "ground_line", theme->ground_line);
    colour_put(json, "impulse", theme->impulse);
    colour_put(json, "velocity", theme->velocity);
    colour_put(json, "event", theme->event);
    colour_put(json, "label_dark", INK);
    colour_put(json, "label_light", PANEL);
    put_body_colors(json, "bomb", &theme->bomb);
    json_put_bool(json, "ghost_is_band", theme->ghost_is_band);
    json_begin_object(json, "ramp", JSON_LINES);
    json_begin_array(json, "stops", JSON_ONE_LINE);
    for (int i = 0; i < THEME_STOPS; i++) colour_put(json, NULL, theme_stops[i]);
    json_end(json);
    json_put_number(json, "near", theme->ramp_near);
    json_put_number(json, "far", theme->ramp_far);
    json_end(json);
    json_end(json);
}

static void put_mark(JsonWriter *json, const char *key, int frame, int body) {
    if (json_put_absent(json, key, frame < 0)) return;
    json_begin_object(json, key, JSON_ONE_LINE);
    json_put_int(json, "frame", frame);
    json_put_int(json, "body", body);
    json_end(json);
}

double player_ems(FontFace face, const char *text) {
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
    json_put_text(json, "caption", player->options->names[index]);
    json_put_text(json, "note", note);
    json_put_number(json, "ems", player_ems(FONT_SEMIBOLD, name));
    json_put_number(json, "note_ems", player_ems(FONT_REGULAR, note));
    json_put_text(json, "file", player->options->files[index]);
    json_put_text(json, "made_of", player->options->scenes[index]);
    json_put_hash(json, "hash",
                  player_run_is_live(player, index) ? trajectory_frame_hash(run, run->frames - 1)
                                                    : trajectory_hash(run));
    if (run->scene_hash != 0)
        json_put_hash(json, "scene_hash", run->scene_hash);
    else
        json_put_text(json, "scene_hash", "");
    json_put_int(json, "iterations", run->iterations);
    json_put_number(json, "dt", (double)run->dt);
    json_put_int(json, "steps", run->frames - 1);
}

static void put_verdict(JsonWriter *json, const Player *player, const Trajectory *run) {
    if (json_put_absent(json, "verdict", run->verdict[0] == '\0')) return;
    json_begin_object(json, "verdict", JSON_ONE_LINE);
    json_put_text(json, "text", run->verdict);
    json_put_int(json, "frame", player_stored(&player->frames, run->verdict_frame));
    json_put_int(json, "body", run->verdict_body);
    json_end(json);
}

void player_put_colours(JsonWriter *json, const char *key, const RunColours *colours) {
    json_begin_object(json, key, JSON_ONE_LINE);
    put_body_colors(json, "light", &colours->light);
    put_body_colors(json, "dark", &colours->dark);
    json_end(json);
}

static void put_run_data(JsonWriter *json, const Player *player, int index) {
    const Trajectory *trajectory = player->picture.runs[index];
    const PlayerRun *run = &player->runs[index];
    json_begin_object(json, NULL, JSON_LINES);
    put_provenance(json, player, index);
    json_put_int(json, "bodies", trajectory->bodies);
    json_put_int(json, "bomb", trajectory->bomb);
    json_put_int(json, "frames", run->frames);
    json_put_int(json, "chunks", run->chunks);
    json_put_bool(json, "masses", trajectory_has_masses(trajectory));
    json_put_bool(json, "names", trajectory->name != NULL);
    json_put_bool(json, "velocities", !trajectory->no_velocities);
    json_put_bool(json, "contacts", run->contacts != NULL || player_run_is_live(player, index));
    json_put_text(json, "live", player->options->live != NULL ? player->options->live->methods[index] : NULL);
    player_put_colours(json, "colours", &player->picture.colours[index]);
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

/* What the page's script (player/codec.js) reads first: JSON. */
static void put_data(FILE *file, const Player *player) {
    JsonWriter json = {.out = file};
    const Trajectory *first = player->picture.runs[0];
    char title[CAPTION_TEXT_SIZE];
    caption_title(&player->picture, title);
    json_begin_object(&json, NULL, JSON_LINES);
    json_put_text(&json, "version", TWINBOX_VERSION);
    json_put_text(&json, "title", title);
    json_put_text(&json, "set", player->options->set != NULL ? player->options->set : "");
    json_put_number(&json, "dt", (double)player_dt(&player->frames, first));
    json_put_int(&json, "every", player->frames.every);
    json_put_int(&json, "first", player->frames.first);
    json_put_int(&json, "frames", player_frame_count(&player->frames, player->picture.frames));
    json_put_int(&json, "total", player->picture.frames);
    json_put_int(&json, "chunk", PLAYER_CHUNK);
    json_put_int(&json, "impact", player_stored(&player->frames, first_impact(&player->picture)));
    json_put_number(&json, "distance_ems", player_ems(FONT_REGULAR, "distance 0.00 m"));
    json_put_number(&json, "out_ems", player_ems(FONT_REGULAR, "00 out of view"));
    json_put_text(&json, "arrow_note", ARROW_NOTE);
    json_put_number(&json, "arrow_note_ems", player_ems(FONT_REGULAR, ARROW_NOTE));
    json_begin_object(&json, "shows", JSON_ONE_LINE);
    for (int i = 0; i < SHOW_COUNT; i++)
        if (show_marks[i].script != NULL) json_put_text(&json, show_marks[i].name, show_marks[i].needs);
    json_end(&json);
    json_put_number(&json, "visible", EVENTS_VISIBLE_DISTANCE);
    json_put_number(&json, "ground", FRAMING_GROUND);
    json_put_number(&json, "farthest", EXTENT_FARTHEST);
    json_begin_array(&json, "font_sizes", JSON_ONE_LINE);
    for (int i = 0; i < FONT_SIZES; i++) json_put_int(&json, NULL, font_sizes[i]);
    json_end(&json);
    put_left_out(&json, player);
    const CameraFrame framing = camera_frame(player->picture.runs, player->picture.count);
    camera_frame_put(&json, "framing", &framing);
    put_measures(&json, player);
    json_begin_object(&json, "themes", JSON_LINES);
    put_theme(&json, "light", theme_get(LOOK_LIGHT));
    put_theme(&json, "dark", theme_get(LOOK_DARK));
    json_end(&json);
    json_begin_array(&json, "runs", JSON_LINES);
    for (int i = 0; i < player->picture.count; i++) put_run_data(&json, player, i);
    json_end(&json);
    if (player->options->live != NULL) player_live_put(&json, player);
    json_end(&json);
}

static void put_head(FILE *file, const Player *player) {
    char title[CAPTION_TEXT_SIZE];
    caption_title(&player->picture, title);
    /* The policy prevents any request, whatever names the page contains. */
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
          "style-src 'unsafe-inline'; script-src",
          file);
    html_put_script_hash(file, player_begin_sha256);
    html_put_script_hash(file, player_viewer_sha256);
    /* A module of WebAssembly, in workers whose script is the page's own. */
    if (player->options->live != NULL) fputs(" 'wasm-unsafe-eval'; worker-src blob:", file);
    fputs("\">\n<link rel=\"icon\" href=\"data:,\">\n<title>", file);
    html_put(file, title);
    for (int i = 0; i < player->picture.count; i++) {
        char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
        caption_method(&player->picture, i, name, note);
        html_print(file, "%s%s", i == 0 ? ": " : ", ", name);
    }
    fprintf(file, "</title>\n<style>\n%s</style>\n</head>\n<body>\n", player_page_css);
}

/* `what`: of a run, or of a chunk of it. */
static void put_packed(FILE *file, const char *what, const void *data, size_t size) {
    fprintf(file, "<script type=\"text/plain\" id=\"%s\">", what);
    base64_put(file, data, size);
    fputs("</script>\n", file);
}

static void put_chunk(FILE *file, char kind, int run, int chunk, const Bytes *bytes) {
    char id[32];
    snprintf(id, sizeof id, "%c%d-%d", kind, run, chunk);
    put_packed(file, id, bytes->data, bytes->size);
}

static void put_run(FILE *file, const Player *player, int index) {
    const Trajectory *trajectory = player->picture.runs[index];
    const PlayerRun *run = &player->runs[index];
    const size_t bodies = (size_t)trajectory->bodies, frames = (size_t)run->frames;
    char id[32];
    snprintf(id, sizeof id, "size%d", index);
    put_packed(file, id, trajectory->size, bodies * sizeof *trajectory->size);
    snprintf(id, sizeof id, "fixed%d", index);
    put_packed(file, id, trajectory->fixed, bodies * sizeof *trajectory->fixed);
    snprintf(id, sizeof id, "mass%d", index);
    if (trajectory_has_masses(trajectory)) put_packed(file, id, trajectory->mass, bodies * sizeof *trajectory->mass);
    snprintf(id, sizeof id, "name%d", index);
    if (trajectory->name != NULL) put_packed(file, id, trajectory->name, bodies * sizeof *trajectory->name);
    if (player_run_is_live(player, index)) return;
    snprintf(id, sizeof id, "hashes%d", index);
    put_packed(file, id, run->hashes, frames * sizeof *run->hashes);
    snprintf(id, sizeof id, "distances%d", index);
    put_packed(file, id, run->distances, frames * sizeof *run->distances);
    for (int k = 0; k < run->chunks; k++) put_chunk(file, 's', index, k, &run->states[k]);
    for (int k = 0; k < run->chunks && run->contacts != NULL; k++) put_chunk(file, 'c', index, k, &run->contacts[k]);
}

/* The first frame is that of all live runs. */
static void put_live(FILE *file, const Player *player) {
    put_packed(file, "module", player->module.data, player->module.size);
    put_packed(file, "bundle", player->bundle.data, player->bundle.size);
    for (int i = 0; i < player->picture.count; i++) {
        const Trajectory *run = player->picture.runs[i];
        if (!player_run_is_live(player, i)) continue;
        put_packed(file, "places", run->position, (size_t)run->bodies * sizeof *run->position);
        put_packed(file, "angles", run->angle, (size_t)run->bodies * sizeof *run->angle);
        break;
    }
}

/* The whole page. The context is a Player. */
static void put_page(FILE *file, const void *context) {
    const Player *player = context;
    put_head(file, player);
    fputs(player_body_html, file);
    fputs(player_help_html, file);
    for (int i = 0; i < player->picture.count; i++) put_run(file, player, i);
    fputs("<script type=\"application/json\" id=\"data\">", file);
    put_data(file, player);
    fputs("</script>\n", file);
    if (player->options->live != NULL) put_live(file, player);
    put_packed(file, "viewer", player->viewer.data, player->viewer.size);
    fprintf(file, "<script>%s</script>\n</body>\n</html>\n", player_begin);
}

/* Of any size: only names, colours and distances count. */
enum { WIDTH = 1280, HEIGHT = 720 };

/* All panels show the same moment. */
static bool check_steps(const Trajectory *const *runs, int count, Error *error) {
    for (int i = 1; i < count; i++)
        if (runs[i]->dt != runs[0]->dt)
            return error_input(error, "page",
                               "run %d (%s) has time steps of %g s, but the first run has %g s; they must be equal",
                               i + 1, runs[i]->method, (double)runs[i]->dt, (double)runs[0]->dt);
    return true;
}

static bool player_plan(Player *player, const Trajectory *const *runs, int count, Error *error) {
    const PlayerOptions *options = player->options;
    const RenderOptions look = {
        .width = WIDTH, .height = HEIGHT, .describe = options->describe, .colours = options->colours};
    if (!check_steps(runs, count, error) || !picture_plan(&player->picture, runs, count, WIDTH, HEIGHT, error) ||
        !picture_apply_options(&player->picture, &look, error))
        return false;
    player->picture.title = options->title; /* after its check of their room: the page cuts what is too long */
    for (int i = 0; i < count; i++) player->picture.captions[i] = options->names[i];
    const int end = player->picture.frames - 1, last = options->last < 0 ? end : options->last;
    if (options->first > end || last > end)
        return error_input(error, "--frames", "%d is beyond the last frame, %d",
                           options->first > end ? options->first : last, end);
    player->frames = (PlayerFrames){options->first, last, options->every > 1 ? options->every : 1};
    return scales_measure(runs[0], &player->measures, error);
}

static bool write_page(const Player *player, const char *path, PlayerResult *result, Error *error) {
    size_t size;
    char *page = file_print(put_page, player, &size);
    const bool ok = page != NULL ? file_write(path, page, size, error) : error_memory(error, path);
    free(page);
    *result = (PlayerResult){player_frame_count(&player->frames, player->picture.frames), (int64_t)size,
                             player->left_contacts};
    return ok;
}

bool player_write(const Trajectory *const *runs, int count, const PlayerOptions *options, const char *path,
                  PlayerResult *result, Error *error) {
    Player player = {.options = options,
                     .most_bytes = options->most_bytes > 0 ? (double)options->most_bytes : PLAYER_MAX_BYTES};
    const bool ok = player_plan(&player, runs, count, error) && find_all_marks(&player, error) &&
                    player_pack(&player, error) && (options->live == NULL || player_live_pack(&player, error)) &&
                    bytes_deflate(&player.viewer, player_viewer, strlen(player_viewer), error) &&
                    write_page(&player, path, result, error);
    player_free(&player);
    return ok;
}

void player_link(char text[PLAYER_LINK_SIZE], double time, int body) {
    const int used = snprintf(text, PLAYER_LINK_SIZE, "#t=%.6g", time);
    if (body >= 0) snprintf(text + used, PLAYER_LINK_SIZE - (size_t)used, "&body=%d", body);
}
