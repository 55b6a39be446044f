/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws trajectories in panels side by side, with the same camera. The same trajectories give the same pixels on
   every machine. */
#pragma once
#include "common/progress.h"
#include "image/image.h"
#include "picture/render_options.h"
#include "pieces/pieces.h"
#include "trajectory/trajectory.h"

/* Hashes of a picture's pixels and of its file (XXH3 of the bytes). */
typedef struct PictureHashes {
    uint64_t pixels, file;
} PictureHashes;

/* Result of render_sequence(). */
typedef struct RenderResult {
    int first, last;       /* indices of the files */
    bool all;              /* the whole run was drawn */
    double rate;           /* pictures per second of the film */
    int kept;              /* of these, unchanged from an earlier call */
    char why[256];         /* options->resume: why nothing could be kept; otherwise empty */
    PictureHashes *hashes; /* [last - first + 1]; freed by the caller */
} RenderResult;

/* Writes directory/frame_000000.png, ...: the moments (moments.h) of the longest of 1 to 6 runs, or of the selected
   frames, numbered from the first one; a shorter run shows its last frame. Without slow motion, hold and cards, file
   k is frame k. manifest.json (manifest.h) describes the pictures. Child processes draw, so the caller's environment
   and threads are unaffected. Progress counts pictures; if it cancels, the pictures in progress are finished and the
   error is "stopped" (ERROR_INTERRUPTED). `result` may be NULL.
   If that is the whole run, frames of an earlier sequence that would remain beside these are removed (stale.h).
   options->resume keeps the pictures of an earlier call, even one that was killed, whose files are unchanged, and
   draws all others. If that call had other runs or options or was another version, it draws all. */
bool render_sequence(const Trajectory *const *panels, int panel_count, const RenderOptions *options,
                     RenderResult *result, const Progress *progress, Error *error);

/* A sequence that shards may draw (pieces/pieces.h). */
typedef struct RenderStudy {
    const PiecesRun *run;
    StudyKey *key; /* of the inputs of a shard or a merge; what the manifest says of the pictures is added */
    /* Called when the folder is reserved, before anything is written there; not for a shard. */
    bool (*begin)(void *context, Error *error);
    void *context;
    Pieces pieces; /* set: what was done; it has no plan */
} RenderStudy;

/* render_sequence() as the whole, as a shard or as a merge; study NULL: as the whole. A piece is a range of consecutive
   pictures. A shard writes the frames of its pieces and nothing else beside them, and *result has no hashes. A merge takes
   the frames as the shards left them; a range of which a frame is missing or altered is missing. */
bool render_study(const Trajectory *const *panels, int panel_count, const RenderOptions *options, RenderStudy *study,
                  RenderResult *result, const Progress *progress, Error *error);

typedef struct Renderer Renderer;

/* Draws single frames in this process; only width, height and context of the options are used. The trajectories must
   outlive the renderer. Sets Mesa's environment variables (context.c). */
Renderer *renderer_create(const Trajectory *const *panels, int panel_count, const RenderOptions *options, Error *error);

/* Draws a frame; the image must have the renderer's size. */
bool renderer_draw(Renderer *renderer, int frame, Image *image, Error *error);
void renderer_destroy(Renderer *renderer);
