/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws panels as frames and videos, with progress bars. */
#pragma once
#include "base/base.h"
#include "cli/panels.h"
#include "pictures/picture.h"
#include "pictures/render.h"
#include "runs/pieces.h"
#include "runs/trajectory.h"

#include <stdbool.h>

enum { DRAW_VIDEOS_MAX = 8 };

/* "-": y4m on standard output. */
typedef struct DrawVideos {
    int count;
    const char *paths[DRAW_VIDEOS_MAX];
} DrawVideos;

/* 1920 x 1080, all frames, one process per core. */
RenderOptions draw_panels_defaults(const char *directory);

/* Checks the videos before anything is drawn: names and sizes; and, unless a merge is to encode them, programs and
   where they go. */
bool draw_videos_check(const DrawVideos *videos, int width, int height, bool of_merge, Error *error);
bool draw_videos_use_output(const DrawVideos *videos);

/* Draws the frames that `render` selects and encodes the videos; a shard draws only. study: render_study(). `result`
   owns no memory afterwards. */
bool draw_panels(const Panels *panels, const RenderOptions *render, const DrawVideos *videos, RenderStudy *study,
                 RenderResult *result, Error *error);

/* Notes on standard error about pictures that may not show what their user expects. */

/* If the runs are of different scenes. A run without a scene_hash is of an unknown scene, and not compared. */
void note_different_scenes(const Trajectory *const *runs, int count);

/* If the frames do not contain the impact, -1 for none, around which they are to be slow. */
void note_missing_impact(const MomentPlan *plan, int impact);

/* If the folder has pictures or runs that are not of the sequence, and not inputs of it. False if it cannot be read. */
bool note_foreign_files(const char *directory, const RenderResult *result, const Panels *panels, Error *error);

/* What 'twinbox render' does for the shards of a film (render_study()). */

/* Everything that decides the files beside what the manifest tells: the program, the runs, as read or as simulated
   here, and the videos. costs: FILE.csv, or NULL. */
bool render_key(StudyKey *key, const Panels *panels, const DrawVideos *videos, const char *costs, Error *error);

/* Whether the merge can read an input again; path may be NULL. */
bool render_check_again(const char *path, Error *error);

/* RenderStudy.begin: stores the runs. context: a RunsPlace. */
typedef struct RunsPlace {
    const Panels *panels;
    const char *directory;
} RunsPlace;
bool render_store_runs(void *context, Error *error);
