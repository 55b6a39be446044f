/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options of render/render.h; a picture needs some of them. */
#pragma once
#include "common/method_description.h"
#include "gl/context.h"
#include "picture/look.h"

#include <stdbool.h>

enum {
    RENDER_PANELS_MAX = LOOK_RUNS_MAX,
    RENDER_SIDE_MIN = 64,
    RENDER_SIDE_MAX = 8192,
    RENDER_JOBS_MAX = 256,
    RENDER_SLOW_MAX = 16, /* factor */
    RENDER_HOLD_MAX = 60, /* s */
    RENDER_FPS_MIN = 1,
    RENDER_FPS_MAX = 240,
    RENDER_DURATION_MAX = 3600 /* s */
};

#define RENDER_DURATION_MIN 0.01 /* s */

typedef struct RenderOptions {
    int width, height; /* pixels, RENDER_SIDE_MIN .. RENDER_SIDE_MAX */
    ContextChoice context;
    int first, last;                         /* frames, inclusive; last -1: to the end */
    int jobs;                                /* processes, 1 .. RENDER_JOBS_MAX */
    const char *directory;                   /* created if missing */
    bool small;                              /* smallest files that libpng can write; slow */
    const char *title;                       /* in the header; NULL: the scene's name */
    const char *captions[RENDER_PANELS_MAX]; /* instead of a run's method and its description; NULL or "": these */
    const char *notes[RENDER_PANELS_MAX];    /* after a panel's method; NULL: none */
    /* The description of a run's method ("engine:k=20"), for its title and caption. NULL, or returns NULL: the text of the
       method is its title. */
    const MethodDescription *(*describe)(const char *method);
    RenderLook look;           /* zeros: bodies side by side */
    int slow;                  /* slow-motion factor around the impact; 0, 1: none */
    double hold;               /* s, repeats the last frame */
    double fps;                /* pictures per second of real time; 0: the run's frames */
    double duration;           /* s, of the whole film: the run is shown faster or slower; 0: real time */
    bool title_card, end_card; /* before and after the run */
    bool resume;               /* keep the frames that an earlier, equal call has written */
} RenderOptions;
