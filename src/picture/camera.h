/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From metres to pixels: one camera for all panels, at rest over the whole run. */
#pragma once
#include "trajectory/trajectory.h"

/* A point (x, y) in metres lies at pixel (left + scale * x, top - scale * y) of a panel. `left` and `top` are
   whole, and so is the scale where it is large: lines at whole metres fall between pixels and stay crisp. */
typedef struct Camera {
    double scale; /* pixels a metre */
    double left, top;
} Camera;

/* True if the scene of the trajectory sets a view of a usable size. */
bool camera_is_set(const Trajectory *trajectory);

/* Shows the view that the scene sets; without one, everything its dynamic bodies pass during the whole run. The panel's
   size is in pixels. */
Camera camera_fit(const Trajectory *trajectory, int width, int height);
