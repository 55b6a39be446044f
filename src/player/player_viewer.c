/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The script that plays the runs, with its comments; deflated, or it would take more room than some runs. */
#include "common/file.h"
#include "player/page.h"
#include "player/player_parts.h"

#include <stdlib.h>

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

bool player_pack_viewer(Player *player, Error *error) {
    size_t size;
    char *text = file_print(put_scripts, NULL, &size);
    const bool ok = text != NULL ? bytes_deflate(&player->viewer, text, size, error) : error_memory(error, "page");
    free(text);
    return ok;
}
