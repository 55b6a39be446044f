/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A moving camera, planned for the whole run so that it can anticipate. */
#pragma once
#include "picture/camera.h"
#include "picture/events.h"
#include "picture/look.h"
#include "picture/moment.h"

/* The cameras of all frames, for panels of this size; the caller frees them. `fit` is the fixed camera. NULL with
   error set if out of memory. Uses only + - * /, so the result is the same on every machine. */
Camera *camera_path(const Trajectory *const *runs, int frames, LookCamera kind, const Events *events, const Camera *fit,
                    int width, int height, Error *error);

/* The camera at a moment, interpolated between frames. */
Camera camera_at(const Camera *path, int frames, Moment moment, int width, int height);
