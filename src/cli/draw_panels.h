/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Panels as frames and videos, with bars of progress. */
#pragma once
#include "cli/panels.h"

enum { DRAW_VIDEOS_MAX = 8 };

/* "-" is standard output, as y4m. */
typedef struct DrawVideos {
    int count;
    const char *paths[DRAW_VIDEOS_MAX];
} DrawVideos;

/* 1920 x 1080, all frames, a process a core. */
RenderOptions draw_panels_defaults(const char *directory);

/* The last frame of the longest panel. */
int panels_last_frame(const Panels *panels);

/* What can be said against the videos before anything is drawn. */
bool draw_videos_check(const DrawVideos *videos, int width, int height, Error *error);
bool draw_videos_use_output(const DrawVideos *videos);

/* Draws the frames that `render` says, and makes the videos. Where they are all there are, those of an earlier, longer run
   go. What `result` then tells of it owns no memory. */
bool draw_panels(const Panels *panels, const RenderOptions *render, const DrawVideos *videos, RenderResult *result,
                 Error *error);
