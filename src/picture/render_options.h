/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is drawn, how large and where to: the options of render/render.h, of which a picture needs a part. */
#pragma once
#include "common/method_description.h"
#include "gl/context.h"
#include "picture/look.h"

#include <stdbool.h>

enum {
    RENDER_PANELS_MAX = LOOK_RUNS_MAX,
    RENDER_LEAST_SIDE = 64,
    RENDER_LARGEST_SIDE = 8192,
    RENDER_JOBS_MAX = 256,
    RENDER_SLOW_MAX = 16, /* times */
    RENDER_HOLD_MAX = 60  /* s */
};

typedef struct RenderOptions {
    int width, height; /* pixels, RENDER_LEAST_SIDE .. RENDER_LARGEST_SIDE */
    ContextChoice context;
    int first, last;                      /* frames, both included; last -1: to the end */
    int jobs;                             /* processes that draw, 1 .. RENDER_JOBS_MAX */
    const char *directory;                /* made where it is missing */
    bool small;                           /* files as small as libpng can make them, which takes long */
    const char *title;                    /* at the head of the picture; NULL: the scene's name */
    const char *notes[RENDER_PANELS_MAX]; /* behind what solved a panel; NULL: none */
    /* The description of a run's method ("engine:k=20"), for its title and caption. NULL, or returns NULL: the text of the
       method is its title. */
    const MethodDescription *(*describe)(const char *method);
    RenderLook look;           /* zeroed: bodies side by side */
    int slow;                  /* times slower around the impact; 0, 1: nowhere */
    double hold;               /* s that the last frame stays */
    bool title_card, end_card; /* before and after the run */
    bool resume;               /* keep what an earlier, equal call has drawn */
} RenderOptions;
