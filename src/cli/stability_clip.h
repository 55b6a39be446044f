/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The moving picture of what happened in a cell of a map of stability. */
#pragma once
#include "common/error.h"

/* Where a map's runs come from. */
typedef struct ClipMap {
    const char *name;                      /* as maps.csv has it */
    const char *scene;                     /* path of the scene file */
    const char *x_parameter, *y_parameter; /* of the scene */
} ClipMap;

typedef struct ClipOptions {
    const char *folder;  /* of maps.csv */
    const char *cell;    /* "MAP:METHOD:X,Y" */
    const ClipMap *maps; /* [map_count] */
    int map_count;
    int width, height; /* of a frame, pixels */
} ClipOptions;

/* Runs the cell again and draws folder/clips/MAP-METHOD-X_Y/frame_000000.png ... and folder/clips/MAP-METHOD-X_Y.mp4, from
   the start until three seconds after what decided the verdict, at most 60 frames a second: at the left the first method
   that holds there, whose camera it is, at the right the cell's own; alone where it holds itself, or nothing does. The
   captions tell methods and verdicts. ERROR_INPUT for a cell that there is not, or a method that does not go with its scene; ERROR_SYSTEM where
   ffmpeg is missing. */
bool stability_clip(const ClipOptions *options, Error *error);
