/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A page that plays runs: where they part, the data that its script reads, the page itself. player_pack.c packs states
   and contacts. */
#include "pictures/player.h"

#include "base/base.h"
#include "base/file.h"
#include "base/json.h"
#include "base/numbers.h"
#include "live/live.h"
#include "methods/methods.h"
#include "methods/names.h"
#include "pictures/pictures_internal.h"
#include "pictures/page.h"
#include "pictures/picture.h"
#include "pictures/player_internal.h"
#include "pixels/gl.h"
#include "runs/compare_runs.h"
#include "runs/trajectory.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static const double POINT = 2e-3; /* of a box: a tenth of a pixel where a box has 50 */
static const double SMALL = 1e-2; /* of common impulses: shorter arrows cannot be seen */

/* What a reader looks for in a run: where it parts from the first one, in a bit and visibly; distances and hashes. */
static bool find_marks(Player *player, int index, Error *error) {
    const Trajectory *first = player->picture.runs[0], *trajectory = player->picture.runs[index];
    const PlayerFrames *frames = &player->frames;
    PlayerRun *run = &player->runs[index];
    run->frames = player_frame_count(frames, trajectory->frames);
    run->chunks = player_run_is_live(player, index) ? 0 : (run->frames + PLAYER_CHUNK - 1) / PLAYER_CHUNK;
    run->differs_frame = run->apart_frame = run->differs_body = run->apart_body = -1;
    run->compared = index == 0 || !trajectory_different_worlds(first, trajectory, run->why, sizeof run->why);
    const int common = index > 0 && run->compared ? int_min(first->frames, trajectory->frames) : 0;
    for (int frame = 0; frame < common && run->apart_frame < 0; frame++)
        for (int body = 0; body < trajectory->bodies && run->apart_frame < 0; body++) {
            if (run->differs_frame < 0 && !trajectory_same_states(first, frame, trajectory, frame, body))
                run->differs_frame = frame, run->differs_body = body;
            if (trajectory_has(first, frame, body) && trajectory_has(trajectory, frame, body) &&
                trajectory_state_difference(first, trajectory, frame, body).distance > EVENTS_VISIBLE_DISTANCE)
                run->apart_frame = frame, run->apart_body = body;
        }
    run->differs_frame = player_stored(frames, run->differs_frame);
    run->apart_frame = player_stored(frames, run->apart_frame);
    if (run->frames == 0)
        return error_input(error, "--frames", "run %d (%s) ends before frame %d", index + 1, trajectory->method,
                           frames->first);
    run->hashes = malloc((size_t)run->frames * sizeof *run->hashes);
    run->distances = malloc((size_t)run->frames * sizeof *run->distances);
    if (run->hashes == NULL || run->distances == NULL) return error_memory(error, "page");
    for (int i = 0; i < run->frames; i++) {
        const int frame = player_frame(frames, i);
        run->hashes[i] = trajectory_frame_hash(trajectory, frame);
        run->distances[i] =
            run->compared ? (float)picture_run_distance(&player->picture, index, moment_stored(frame)) : NAN;
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
    colour_put(json, "slips", theme->slips);
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
    if (run->network_hash != 0) json_put_hash(json, "network_hash", run->network_hash);
    json_put_text(json, "name", name);
    json_put_text(json, "caption", player->options->names[index]);
    json_put_text(json, "note", note);
    json_put_number(json, "ems", ems(FONT_SEMIBOLD, name));
    json_put_number(json, "note_ems", ems(FONT_REGULAR, note));
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

/* The colours of a run's boxes, by theme. */
static void put_colours(JsonWriter *json, const char *key, const RunColours *colours) {
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
    put_colours(json, "colours", &player->picture.colours[index]);
    if (!json_put_absent(json, "verdict", trajectory->verdict[0] == '\0')) {
        json_begin_object(json, "verdict", JSON_ONE_LINE);
        json_put_text(json, "text", trajectory->verdict);
        json_put_int(json, "frame", player_stored(&player->frames, trajectory->verdict_frame));
        json_put_int(json, "body", trajectory->verdict_body);
        json_end(json);
    }
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

/* The methods that a page offers to step itself. */
static void put_methods(JsonWriter *json, const Player *player) {
    json_begin_object(json, "live", JSON_LINES);
    json_begin_array(json, "methods", JSON_LINES);
    for (const MethodKind *kind = method_kinds; kind->description != NULL; kind++) {
        const MethodDescription *method = kind->description;
        RunColours family[COLOUR_SHADES];
        if (!live_has_method(method)) continue;
        colours_family(method->name, &player->options->colours, family);
        json_begin_object(json, NULL, JSON_LINES);
        json_put_text(json, "name", method->name);
        json_put_number(json, "ems", ems(FONT_SEMIBOLD, method->name));
        json_put_text(json, "note", method->caption);
        json_put_number(json, "note_ems", method->caption != NULL ? ems(FONT_REGULAR, method->caption) : 0);
        json_begin_array(json, "shades", JSON_LINES); /* readers' panels follow the rule of pictures/colours.h, too */
        for (int i = 0; i < COLOUR_SHADES; i++) put_colours(json, NULL, &family[i]);
        json_end(json);
        json_end(json);
    }
    json_end(json);
    json_end(json);
}

/* What the page's script (player/codec.js) reads first: JSON. The context is a Player. */
static void put_data(FILE *file, const void *context) {
    const Player *player = context;
    JsonWriter json = {.out = file};
    const Trajectory *first = player->picture.runs[0];
    char title[CAPTION_TEXT_SIZE];
    int impact = -1; /* of the first run that has one */
    for (int i = 0; i < player->picture.count && impact < 0; i++) impact = trajectory_impact(player->picture.runs[i]);
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
    json_put_int(&json, "impact", player_stored(&player->frames, impact));
    json_put_number(&json, "distance_ems", ems(FONT_REGULAR, "distance 0.00 m"));
    json_put_number(&json, "out_ems", ems(FONT_REGULAR, "00 out of view"));
    json_put_text(&json, "arrow_note", ARROW_NOTE);
    json_put_number(&json, "arrow_note_ems", ems(FONT_REGULAR, ARROW_NOTE));
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
    json_begin_object(&json, "scales", JSON_ONE_LINE);
    json_put_number(&json, "impulse", player->measures.impulse);
    json_put_number(&json, "speed", player->measures.speed);
    json_put_number(&json, "box", player->measures.box);
    json_put_number(&json, "largest", player->picture.largest_distance);
    json_end(&json);
    json_begin_object(&json, "units", JSON_ONE_LINE);
    json_put_number(&json, "length", (double)player->units.length);
    json_put_number(&json, "impulse", (double)player->units.impulse);
    json_end(&json);
    json_begin_object(&json, "themes", JSON_LINES);
    put_theme(&json, "light", theme_get(LOOK_LIGHT));
    put_theme(&json, "dark", theme_get(LOOK_DARK));
    json_end(&json);
    json_begin_array(&json, "runs", JSON_LINES);
    for (int i = 0; i < player->picture.count; i++) put_run_data(&json, player, i);
    json_end(&json);
    if (player->options->live != NULL) put_methods(&json, player);
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

/* An element with data: of a run, of a chunk of it, or of the page. */
PRINTF_LIKE(4, 5) static void put_packed(FILE *file, const void *data, size_t size, const char *id, ...) {
    va_list numbers;
    va_start(numbers, id);
    fputs("<script type=\"text/plain\" id=\"", file);
    vfprintf(file, id, numbers);
    fputs("\">", file);
    va_end(numbers);
    bytes_put_digits(file, data, size);
    fputs("</script>\n", file);
}

static void put_run(FILE *file, const Player *player, int index) {
    const Trajectory *trajectory = player->picture.runs[index];
    const PlayerRun *run = &player->runs[index];
    const size_t bodies = (size_t)trajectory->bodies, frames = (size_t)run->frames;
    put_packed(file, trajectory->size, bodies * sizeof *trajectory->size, "size%d", index);
    put_packed(file, trajectory->fixed, bodies * sizeof *trajectory->fixed, "fixed%d", index);
    if (trajectory_has_masses(trajectory))
        put_packed(file, trajectory->mass, bodies * sizeof *trajectory->mass, "mass%d", index);
    if (trajectory->name != NULL)
        put_packed(file, trajectory->name, bodies * sizeof *trajectory->name, "name%d", index);
    if (player_run_is_live(player, index)) return;
    put_packed(file, run->hashes, frames * sizeof *run->hashes, "hashes%d", index);
    put_packed(file, run->distances, frames * sizeof *run->distances, "distances%d", index);
    for (int k = 0; k < run->chunks; k++)
        put_packed(file, run->states[k].data, run->states[k].size, "s%d-%d", index, k);
    for (int k = 0; k < run->chunks && run->contacts != NULL; k++)
        put_packed(file, run->contacts[k].data, run->contacts[k].size, "c%d-%d", index, k);
}

/* The whole page. The context is a Player. */
static void put_page(FILE *file, const void *context) {
    const Player *player = context;
    put_head(file, player);
    fputs(player_body_html, file);
    fputs(player_help_html, file);
    for (int i = 0; i < player->picture.count; i++) put_run(file, player, i);
    put_packed(file, player->data.data, player->data.size, "data");
    if (player->options->live != NULL) {
        put_packed(file, player->module.data, player->module.size, "module");
        put_packed(file, player->bundle.data, player->bundle.size, "bundle");
    }
    for (int i = 0; i < player->picture.count; i++) { /* the first frame is that of all live runs */
        const Trajectory *run = player->picture.runs[i];
        if (!player_run_is_live(player, i)) continue;
        put_packed(file, run->position, (size_t)run->bodies * sizeof *run->position, "places");
        put_packed(file, run->angle, (size_t)run->bodies * sizeof *run->angle, "angles");
        break;
    }
    put_packed(file, player->viewer.data, player->viewer.size, "viewer");
    fprintf(file, "<script>%s</script>\n</body>\n</html>\n", player_begin);
}

/* Of any size: only names, colours and distances count. */
enum { WIDTH = 1280, HEIGHT = 720 };

static bool make_plan(Player *player, const Trajectory *const *runs, int count, Error *error) {
    const PlayerOptions *options = player->options;
    const RenderOptions look = {
        .width = WIDTH, .height = HEIGHT, .describe = options->describe, .colours = options->colours};
    for (int i = 1; i < count; i++) /* all panels show the same moment */
        if (runs[i]->dt != runs[0]->dt)
            return error_input(error, "page",
                               "run %d (%s) has time steps of %g s, but the first run has %g s; they must be equal",
                               i + 1, runs[i]->method, (double)runs[i]->dt, (double)runs[0]->dt);
    if (!picture_plan(&player->picture, runs, count, WIDTH, HEIGHT, error) ||
        !picture_apply_options(&player->picture, &look, error))
        return false;
    player->picture.title = options->title; /* after its check of their room: the page cuts what is too long */
    for (int i = 0; i < count; i++) player->picture.captions[i] = options->names[i];
    const int end = player->picture.frames - 1, last = options->last < 0 ? end : options->last;
    if (options->first > end || last > end)
        return error_input(error, "--frames", "%d is beyond the last frame, %d",
                           options->first > end ? options->first : last, end);
    player->frames = (PlayerFrames){options->first, last, options->every > 1 ? options->every : 1};
    if (!scales_measure(runs[0], &player->measures, error)) return false;
    const double impulse = SMALL * player->measures.impulse;
    player->units = (ContactUnits){(float)(POINT * player->measures.box), impulse > 0 ? (float)impulse : 1};
    for (int i = 0; i < count; i++)
        if (!find_marks(player, i, error)) return false;
    return true;
}

/* All but the runs. */
static bool pack_page(Player *player, Error *error) {
    const PlayerLive *live = player->options->live;
    size_t size;
    char *data = file_print(put_data, player, &size);
    const bool ok = data != NULL ? bytes_deflate(&player->data, data, size, error) : error_memory(error, "page");
    free(data);
    return ok && bytes_deflate(&player->viewer, player_viewer, strlen(player_viewer), error) &&
           (live == NULL || (bytes_deflate(&player->module, live->module.bytes, live->module.size, error) &&
                             bytes_deflate(&player->bundle, live->bundle, live->bundle_size, error)));
}

bool player_write(const Trajectory *const *runs, int count, const PlayerOptions *options, const char *path,
                  PlayerResult *result, Error *error) {
    Player player = {.options = options,
                     .most_bytes = options->most_bytes > 0 ? (double)options->most_bytes : PLAYER_MAX_BYTES};
    bool ok = make_plan(&player, runs, count, error) && player_pack(&player, error) && pack_page(&player, error);
    if (ok) {
        size_t size;
        char *page = file_print(put_page, &player, &size);
        ok = page != NULL ? file_write(path, page, size, error) : error_memory(error, path);
        free(page);
        *result = (PlayerResult){player_frame_count(&player.frames, player.picture.frames), (int64_t)size,
                                 player.left_contacts};
    }
    player_free(&player);
    return ok;
}

void player_link(char text[PLAYER_LINK_SIZE], double time, int body) {
    const int used = snprintf(text, PLAYER_LINK_SIZE, "#t=%.6g", time);
    if (body >= 0) snprintf(text + used, PLAYER_LINK_SIZE - (size_t)used, "&body=%d", body);
}
