/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Draws trajectories: one panel each, side by side, by the same camera. The same trajectories give the same
   pixels on every machine. */
#pragma once
#include "common/progress.h"
#include "image/image.h"
#include "render/look.h"
#include "trajectory/trajectory.h"

typedef enum RenderContext { RENDER_CONTEXT_AUTO, RENDER_CONTEXT_OSMESA, RENDER_CONTEXT_EGL } RenderContext;

enum { RENDER_PANELS_MAX = LOOK_RUNS_MAX, RENDER_LEAST_SIDE = 64, RENDER_LARGEST_SIDE = 8192, RENDER_JOBS_MAX = 256 };

typedef struct RenderOptions {
    int width, height; /* pixels, RENDER_LEAST_SIDE .. RENDER_LARGEST_SIDE */
    RenderContext context;
    int first, last;                      /* frames, both included; last -1: to the end */
    int jobs;                             /* processes that draw, 1 .. RENDER_JOBS_MAX */
    const char *directory;                /* made where it is missing */
    bool small;                           /* files as small as libpng can make them, which takes long */
    const char *title;                    /* at the head of the picture; NULL: the scene's name */
    const char *notes[RENDER_PANELS_MAX]; /* behind what solved a panel; NULL: none */
    RenderLook look;                      /* zeroed: bodies side by side */
} RenderOptions;

/* Writes directory/frame_000000.png and on: all frames of the longest of 1 to 6 panels, or the range asked
   for; a shorter panel holds its last frame. Processes of its own draw, so that the caller keeps its
   environment and threads. Progress counts frames; where it asks to stop, the frames begun are finished and
   the error is "stopped" (ERROR_INPUT). */
bool render_sequence(const Trajectory *const *panels, int panel_count, const RenderOptions *options,
                     const Progress *progress, Error *error);

typedef struct Renderer Renderer;

/* For single frames, drawn in this process; of the options only width, height and context count. The
   trajectories must outlive the renderer. Sets Mesa's environment variables (context.c). */
Renderer *renderer_create(const Trajectory *const *panels, int panel_count, const RenderOptions *options, Error *error);

/* Draws a frame into an image of the renderer's size. */
bool renderer_draw(Renderer *renderer, int frame, Image *image, Error *error);
void renderer_destroy(Renderer *renderer);
