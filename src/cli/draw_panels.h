/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Panels as frames and a video, with bars of progress. */
#pragma once
#include "cli/panels.h"

/* 1920 x 1080, all frames, a process a core. */
RenderOptions draw_panels_defaults(const char *directory);

/* The last frame of the longest panel. */
int panels_last_frame(const Panels *panels);

/* Draws the frames that `render` says, and encodes them where `video` is not NULL. Where they are all there are, those of an
   earlier, longer run go. render->last becomes the last one drawn. */
bool draw_panels(const Panels *panels, RenderOptions *render, const char *video, Error *error);
