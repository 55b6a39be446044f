/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of one frame of a comparison: panels side by side below one header. Independent of OpenGL. */
#pragma once
#include "picture/camera.h"
#include "picture/events.h"
#include "picture/layout.h"
#include "picture/moment.h"
#include "picture/scales.h"
#include "picture/theme.h"

/* Everything that is chosen once per sequence, from the whole run, so that only bodies move between frames. */
typedef struct Picture {
    const Trajectory *runs[RENDER_PANELS_MAX]; /* one panel per run, unless the look requires otherwise */
    int count;
    int frames; /* of the longest run */
    Layout layout;
    Camera camera;           /* for a panel whose upper left corner is (0, 0) */
    double grid_scale;       /* pixels per metre used to choose the grid; constant while the camera moves */
    double largest_distance; /* m, over the whole run */
    double run_largest[RENDER_PANELS_MAX]; /* the same, per run */
    const char *title;                     /* as in RenderOptions; must outlive the picture */
    const char *captions[RENDER_PANELS_MAX];
    const char *notes[RENDER_PANELS_MAX];
    const MethodDescription *methods[RENDER_PANELS_MAX]; /* of the runs; NULL: unknown */
    MethodColour colours[RENDER_PANELS_MAX];             /* of the runs, all different */
    RenderLook look;
    const Theme *theme;
    int panel_count; /* number of panels drawn */
    Events events;
    Scales scales;
    Camera *path;  /* [frames], or NULL if the camera is fixed */
    float *curves; /* [count][curve_points], m: the largest distance from the first run in each interval; NaN after
                      the run's end. NULL without a timeline. */
    int curve_points;
} Picture;

/* Plans a picture with the default look. ERROR_INPUT if the runs cannot be shown side by side. The trajectories must
   outlive the picture. */
bool picture_plan(Picture *picture, const Trajectory *const *runs, int count, int width, int height, Error *error);

/* Takes the texts and the look from the options, or fails like look_check(). picture_free() frees the result, also
   after an error. */
bool picture_apply_options(Picture *picture, const RenderOptions *options, Error *error);
void picture_free(Picture *picture);

/* Plans and discards: whether the runs can be drawn with these options. */
bool picture_check(const Trajectory *const *runs, int count, const RenderOptions *options, Error *error);

/* ERROR_INPUT if the runs do not support the look: it compares different bodies, or follows a bomb that does not
   exist. */
bool look_check(const RenderLook *look, const Trajectory *const *runs, int count, Error *error);

/* The camera of a moment, for a panel whose upper left corner is (0, 0). */
Camera picture_camera(const Picture *picture, Moment moment);

/* Draws a moment into a cleared drawing. */
void picture_draw(const Picture *picture, Moment moment, Drawing *drawing);

/* The frame that a run shows: its last one after it has ended. */
int picture_run_frame(const Picture *picture, int run, int frame);

/* The run that a panel shows; for an overlay the first. */
int picture_run(const Picture *picture, int panel);

/* Whether a panel shows the run's bodies as outlines. */
bool picture_draws_outlines(const Picture *picture, int panel, int run);

/* The colours of a run's bodies, and of its bodies as outlines over those of other runs. */
const BodyColors *picture_body_colors(const Picture *picture, int run);
uint32_t picture_ghost_color(const Picture *picture, int run);

/* Whether the run's bodies are coloured by their distance from the first run's. */
bool picture_colors_distance(const Picture *picture, int run);

/* The largest distance (m) of a body from the same body in the first run; NaN for the first run and after the end of
   either. */
double picture_run_distance(const Picture *picture, int run, Moment moment);

/* The largest over all runs. */
double picture_distance(const Picture *picture, Moment moment);
