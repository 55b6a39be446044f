/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The fixed parts of the page (src/player/page), embedded in the binary by common/tools/embed.cmake. */
#pragma once

extern const char player_page_css[], player_body_html[], player_help_html[];
extern const char player_begin_js[];
extern const char player_codec_js[], player_world_js[];
extern const char player_layout_js[], player_camera_js[], player_grid_js[], player_boxes_js[], player_marks_js[],
    player_captions_js[], player_legend_js[], player_picture_js[];
extern const char player_state_js[], player_plot_js[], player_time_js[], player_pointer_js[], player_measure_js[],
    player_keys_js[], player_link_js[], player_actions_js[], player_summary_js[], player_main_js[];
