/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A camera that moves: planned for the whole run, so that it can ease into what comes. */
#pragma once
#include "picture/camera.h"
#include "picture/events.h"
#include "picture/look.h"
#include "picture/moment.h"

/* The cameras of all frames, for panels of this size; the caller frees them. `fit` is the one at rest. NULL with error set
   when memory is short. Only sums, products and quotients, which are the same on every machine. */
Camera *camera_path(const Trajectory *const *runs, int frames, LookCamera kind, const Events *events, const Camera *fit,
                    int width, int height, Error *error);

/* Between two frames the camera is between theirs. */
Camera camera_at(const Camera *path, int frames, Moment moment, int width, int height);
