/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The options --camera X,Y,W,H and --view-from RUN of pictures and figures. */
#pragma once
#include "cli/options.h"
#include "picture/camera.h"

#define CAMERA_OPTION_VIEW "X,Y,W,H: the view around the point (X, Y), W wide and H high, in metres"

/* An option's value "X,Y,W,H". */
bool camera_option_read(const Option *option, const char *text, void *view, Error *error);

/* Reads the run of --view-from, which the caller destroys; NULL if there is no `path`. ERROR_INPUT beside a view. */
bool camera_option_load(const char *path, const CameraView *view, Trajectory **run, Error *error);
