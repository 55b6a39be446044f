/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The camera, from metres to pixels: the same for all panels, fixed over the whole run. */
#pragma once
#include "trajectory/trajectory.h"

/* A point (x, y) in metres is at pixel (left + scale * x, top - scale * y) of a panel. `left` and `top` are
   integers, and so is a large scale: grid lines at whole metres then fall between pixels and stay crisp. */
typedef struct Camera {
    double scale; /* pixels per metre */
    double left, top;
} Camera;

/* True if the trajectory sets a view of a usable size. */
bool camera_is_set(const Trajectory *trajectory);

/* Shows the view that the trajectory sets; otherwise all that its dynamic bodies reach over the whole run (its
   static ones if it has no others). Width and height of the panel in pixels. */
Camera camera_fit(const Trajectory *trajectory, int width, int height);
