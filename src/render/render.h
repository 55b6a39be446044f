/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws trajectories: one panel each, side by side, by the same camera. The same trajectories give the same
   pixels on every machine. */
#pragma once
#include "common/progress.h"
#include "image/image.h"
#include "picture/render_options.h"
#include "trajectory/trajectory.h"

/* Of a picture and of the file that it is in (XXH3 of its bytes). */
typedef struct PictureHashes {
    uint64_t pixels, file;
} PictureHashes;

/* What became of a sequence. */
typedef struct RenderResult {
    int first, last;       /* numbers of the files */
    bool all;              /* these are all there are */
    int kept;              /* of them, found whole from an earlier call */
    char why[256];         /* to resume, and nothing could be: why; else empty */
    PictureHashes *hashes; /* [last - first + 1]; to be freed by the caller */
} RenderResult;

/* Writes directory/frame_000000.png and on: the moments (moments.h) of the longest of 1 to 6 panels, or of the frames asked
   for, which begin with the number of the first; a shorter panel holds its last frame. Without slow motion, hold and cards file k is frame k. Beside them
   manifest.json (manifest.h) tells what was drawn. Processes of its own draw, so that the caller keeps its environment and
   threads. Progress counts pictures; where it asks to stop, those begun are finished and the error is "stopped"
   (ERROR_INPUT). `result` may be NULL.

   To resume: pictures of an earlier call, ended or killed, whose files have the bytes that they had then stay; all others
   are drawn. Where that call was of other runs, options or another version, all are. */
bool render_sequence(const Trajectory *const *panels, int panel_count, const RenderOptions *options,
                     RenderResult *result, const Progress *progress, Error *error);

typedef struct Renderer Renderer;

/* For single frames, drawn in this process; of the options only width, height and context count. The
   trajectories must outlive the renderer. Sets Mesa's environment variables (context.c). */
Renderer *renderer_create(const Trajectory *const *panels, int panel_count, const RenderOptions *options, Error *error);

/* Draws a frame into an image of the renderer's size. */
bool renderer_draw(Renderer *renderer, int frame, Image *image, Error *error);
void renderer_destroy(Renderer *renderer);
