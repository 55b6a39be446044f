/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws panels as frames and videos, with progress bars. */
#pragma once
#include "cli/panels.h"

enum { DRAW_VIDEOS_MAX = 8 };

/* "-": y4m on standard output. */
typedef struct DrawVideos {
    int count;
    const char *paths[DRAW_VIDEOS_MAX];
} DrawVideos;

/* 1920 x 1080, all frames, one process per core. */
RenderOptions draw_panels_defaults(const char *directory);

/* The last frame of the longest panel. */
int panels_last_frame(const Panels *panels);

/* Checks the videos before anything is drawn: names and sizes; and, unless a merge is to encode them, programs and where
   they go. */
bool draw_videos_check(const DrawVideos *videos, int width, int height, bool of_merge, Error *error);
bool draw_videos_use_output(const DrawVideos *videos);

/* Draws the frames that `render` selects and encodes the videos; a shard draws only. study: render_study(). `result` owns
   no memory afterwards. */
bool draw_panels(const Panels *panels, const RenderOptions *render, const DrawVideos *videos, RenderStudy *study,
                 RenderResult *result, Error *error);
