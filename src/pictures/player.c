/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pictures/player.h"

#include "base/base.h"
#include "base/file.h"
#include "pictures/internal.h"
#include "pictures/page.h"
#include "pictures/picture.h"
#include "pictures/player_internal.h"
#include "runs/trajectory.h"

#include <stdio.h>
#include <stdlib.h>

static void put_head(FILE *file, const Player *player) {
    char title[CAPTION_TEXT_SIZE];
    caption_title(&player->picture, title);
    /* The policy prevents any request, whatever names the page contains. */
    fputs("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
          "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
          "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
          "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n<link rel=\"icon\" href=\"data:,\">\n<title>",
          file);
    html_put(file, title);
    for (int i = 0; i < player->picture.count; i++) {
        char name[CAPTION_TEXT_SIZE], note[CAPTION_TEXT_SIZE];
        caption_method(&player->picture, i, name, note);
        fputs(i == 0 ? ": " : ", ", file);
        html_put(file, name);
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
    snprintf(id, sizeof id, "hashes%d", index);
    put_packed(file, id, run->hashes, frames * sizeof *run->hashes);
    snprintf(id, sizeof id, "distances%d", index);
    put_packed(file, id, run->distances, frames * sizeof *run->distances);
    for (int k = 0; k < run->chunks; k++) put_chunk(file, 's', index, k, &run->states[k]);
    for (int k = 0; k < run->chunks && run->contacts != NULL; k++) put_chunk(file, 'c', index, k, &run->contacts[k]);
}

/* The whole page. The context is a Player. */
static void player_put_page(FILE *file, const void *context) {
    const Player *player = context;
    put_head(file, player);
    fputs(player_body_html, file);
    fputs(player_help_html, file);
    for (int i = 0; i < player->picture.count; i++) put_run(file, player, i);
    fputs("<script type=\"application/json\" id=\"data\">", file);
    player_put_data(file, player);
    fputs("</script>\n", file);
    put_packed(file, "viewer", player->viewer.data, player->viewer.size);
    fprintf(file, "<script>\n%s</script>\n</body>\n</html>\n", player_begin_js);
}

/* The script that plays the runs, with its comments; deflated, or it would take more room than some runs. */

/* In one scope, in the order of use. */
static void put_scripts(FILE *file, const void *context) {
    const char *const scripts[] = {player_codec_js,  player_world_js,   player_layout_js,  player_camera_js,
                                   player_grid_js,   player_boxes_js,   player_marks_js,   player_captions_js,
                                   player_legend_js, player_picture_js, player_state_js,   player_plot_js,
                                   player_time_js,   player_pointer_js, player_measure_js, player_keys_js,
                                   player_link_js,   player_actions_js, player_summary_js, player_main_js};
    (void)context;
    fputs("\"use strict\";\n{\n", file);
    for (size_t i = 0; i < sizeof scripts / sizeof scripts[0]; i++) fprintf(file, "%s\n", scripts[i]);
    fputs("}\n", file);
}

static bool player_pack_viewer(Player *player, Error *error) {
    size_t size;
    char *text = file_print(put_scripts, NULL, &size);
    const bool ok = text != NULL ? bytes_deflate(&player->viewer, text, size, error) : error_memory(error, "page");
    free(text);
    return ok;
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

static bool plan(Player *player, const Trajectory *const *runs, int count, Error *error) {
    const PlayerOptions *options = player->options;
    RenderOptions look = {.width = WIDTH, .height = HEIGHT, .title = options->title, .describe = options->describe};
    for (int i = 0; i < count; i++) look.captions[i] = options->names[i];
    if (!check_steps(runs, count, error) || !picture_plan(&player->picture, runs, count, WIDTH, HEIGHT, error) ||
        !picture_apply_options(&player->picture, &look, error))
        return false;
    const int end = player->picture.frames - 1, last = options->last < 0 ? end : options->last;
    if (options->first > end || last > end)
        return error_input(error, "--frames", "%d is beyond the last frame, %d",
                           options->first > end ? options->first : last, end);
    player->frames = (PlayerFrames){options->first, last, options->every > 1 ? options->every : 1};
    return scales_measure(runs[0], &player->measures, error);
}

static bool write_page(const Player *player, const char *path, PlayerResult *result, Error *error) {
    size_t size;
    char *page = file_print(player_put_page, player, &size);
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
    const bool ok = plan(&player, runs, count, error) && player_find_marks(&player, error) &&
                    player_pack(&player, error) && player_pack_viewer(&player, error) &&
                    write_page(&player, path, result, error);
    player_free(&player);
    return ok;
}

void player_link(char text[PLAYER_LINK_SIZE], double time, int body) {
    const int used = snprintf(text, PLAYER_LINK_SIZE, "#t=%.6g", time);
    if (body >= 0) snprintf(text + used, PLAYER_LINK_SIZE - (size_t)used, "&body=%d", body);
}
