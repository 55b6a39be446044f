/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a frame of a comparison looks like: panels side by side under one header. No OpenGL here. */
#pragma once
#include "picture/camera.h"
#include "picture/events.h"
#include "picture/layout.h"
#include "picture/moment.h"
#include "picture/scales.h"
#include "picture/theme.h"

/* All that is decided once for a sequence, from the whole run, so that nothing moves between frames but
 * bodies. */
typedef struct Picture {
    const Trajectory *panels[RENDER_PANELS_MAX]; /* the runs: each has its panel, unless the look says otherwise */
    int count;
    int frames; /* of the longest run */
    Layout layout;
    Camera camera;                     /* for a panel whose upper left corner is (0, 0) */
    double grid_scale;                 /* pixels a metre that the grid is chosen for: it does not change on the way */
    double largest_apart;              /* m, over the run */
    double largest[RENDER_PANELS_MAX]; /* the same of each run from the first */
    const char *title;                 /* as in RenderOptions; outlive the picture */
    const char *notes[RENDER_PANELS_MAX];
    const MethodDescription *methods[RENDER_PANELS_MAX]; /* of the runs; NULL: unknown */
    RenderLook look;
    const Theme *theme;
    int shown; /* panels that are drawn */
    Events events;
    Scales scales;
    Camera *path;  /* [frames], where the camera moves; else NULL */
    float *curves; /* [count][curve_points] m, the largest distance from the first run in each part of the run; NAN once
                       the run has ended. NULL without a timeline. */
    int curve_points;
} Picture;

/* Refuses (ERROR_INPUT) what cannot be shown side by side. The trajectories must outlive the picture. */
bool picture_plan(Picture *picture, const Trajectory *const *panels, int count, int width, int height, Error *error);

/* Takes over the options' words and look, or refuses what look_check() does. What it makes is freed by picture_free, also
   after an error. */
bool picture_dress(Picture *picture, const RenderOptions *options, Error *error);
void picture_free(Picture *picture);

/* Refuses (ERROR_INPUT) a look that the runs do not have: comparing other bodies, following a bomb where there is none. */
bool look_check(const RenderLook *look, const Trajectory *const *runs, int count, Error *error);

/* Puts a moment into a cleared drawing. */
void picture_draw(const Picture *picture, Moment moment, Drawing *drawing);

/* The frame that a run shows: its last one once it has ended. */
int picture_panel_frame(const Picture *picture, int run, int frame);

/* Which run a panel shows; of an overlay the first. */
int picture_run(const Picture *picture, int panel);

/* True where the run's bodies are coloured by their distance from the first run's. */
bool picture_colors_distance(const Picture *picture, int run);

/* The largest distance (m) of a body in a run from the same body in the first; NaN where nothing can be compared: it is
   the first, or one of the two has ended. */
double picture_run_apart(const Picture *picture, int run, Moment moment);

/* The same over all runs. */
double picture_apart(const Picture *picture, Moment moment);
