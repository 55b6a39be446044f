/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "player/player.h"

#include "common/file.h"
#include "player/player_parts.h"

#include <stdio.h>
#include <stdlib.h>

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
