/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What 'twinbox render' does for the shards of a film (render_study()). */
#pragma once
#include "cli/draw_panels.h"

/* Everything that decides the files beside what the manifest tells: the program, the runs, as read or as simulated here, and
   the videos. costs: FILE.csv, or NULL. */
bool render_key(StudyKey *key, const Panels *panels, const DrawVideos *videos, const char *costs, Error *error);

/* Whether the merge can read an input again; path may be NULL. */
bool render_check_again(const char *path, Error *error);

/* RenderStudy.begin: stores the runs. context: a RunsPlace. */
typedef struct RunsPlace {
    const Panels *panels;
    const char *directory;
} RunsPlace;
bool render_store_runs(void *context, Error *error);
