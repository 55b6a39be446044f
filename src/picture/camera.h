/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The camera, from metres to pixels: the same for all panels. */
#pragma once
#include "trajectory/trajectory.h"

/* A point (x, y) in metres is at pixel (left + scale * x, top - scale * y) of a panel. `left` and `top` are
   integers, and so is a large scale: grid lines at whole metres then fall between pixels and stay crisp. */
typedef struct Camera {
    double scale; /* pixels per metre */
    double left, top;
} Camera;

/* A part of the world, in metres: its centre and its size. */
typedef struct CameraView {
    double x, y, width, height; /* width 0: none */
} CameraView;

/* True if the view has a size that can be drawn. */
bool camera_view_is_usable(const CameraView *view);

/* The view that the run's scene sets; false if it sets none that is usable. */
bool camera_view_of(const Trajectory *run, CameraView *view);

/* Shows a usable view in the middle of a panel; width and height in pixels. */
Camera camera_show(const CameraView *view, int width, int height);

/* Width and height in metres of what camera_fit() shows, with its margin. */
Vec2 camera_needs(const Trajectory *run);

/* What camera_fit() shows. */
typedef struct CameraFrame {
    bool set;                        /* by the scene: shown in the middle of a panel */
    double left, right, bottom, top; /* m, with the margin */
    double middle;                   /* m, x of the middle of what stands */
} CameraFrame;

CameraFrame camera_frame(const Trajectory *run);

/* Shows the view that the run's scene sets, otherwise what stands and what strikes it (framing.h). */
Camera camera_fit(const Trajectory *run, int width, int height);
