/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a frame of a comparison looks like: panels side by side under one header. No OpenGL here. */
#pragma once
#include "render/camera.h"
#include "render/layout.h"
#include "render/moment.h"

/* All that is decided once for a sequence, from the whole run, so that nothing moves between frames but
 * bodies. */
typedef struct Picture {
    const Trajectory *panels[RENDER_PANELS_MAX];
    int count;
    int frames; /* of the longest panel */
    Layout layout;
    Camera camera;        /* for a panel whose upper left corner is (0, 0) */
    double largest_apart; /* m, over the run */
    const char *title;    /* as in RenderOptions; outlive the picture */
    const char *notes[RENDER_PANELS_MAX];
} Picture;

/* Refuses (ERROR_INPUT) what cannot be shown side by side. The trajectories must outlive the picture. */
bool picture_plan(Picture *picture, const Trajectory *const *panels, int count, int width, int height, Error *error);

/* Takes over the options' words and look. Refuses (ERROR_INPUT) a look that the runs do not have: a comparison of other
   bodies, a bomb to follow where there is none. What it makes is freed by picture_free, also after an error. */
bool picture_dress(Picture *picture, const RenderOptions *options, Error *error);
void picture_free(Picture *picture);

/* Puts a moment into a cleared drawing. */
void picture_draw(const Picture *picture, Moment moment, Drawing *drawing);

/* The frame that a panel shows: its last one once it has ended. */
int picture_panel_frame(const Picture *picture, int panel, int frame);

/* The largest distance (m) of a body in any panel from the same body in the first; NaN where nothing can be
   compared: there is but one panel, or all others have ended. */
double picture_apart(const Picture *picture, int frame);
