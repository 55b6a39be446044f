/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The video of one cell of a stability map. */
#pragma once
#include "cli/stability_runs.h"

typedef struct ClipOptions {
    const char *folder;  /* of maps.csv */
    const char *cell;    /* "MAP:METHOD:X,Y" */
    const ClipMap *maps; /* [map_count] */
    int map_count;
    int width, height; /* of a frame, pixels */
} ClipOptions;

/* Runs the cell again and draws folder/clips/MAP-METHOD-X_Y/frame_000000.png ... and folder/clips/MAP-METHOD-X_Y.mp4,
   from the start until three seconds after the frame that decided the verdict, at most 60 frames per second. Left: the
   first method that holds there, which also sets the camera; right: the method of the cell. If that one holds, or none
   does, it is alone. Captions give methods and verdicts. ERROR_INPUT: the cell does not exist, or the method cannot run
   its scene; ERROR_SYSTEM: ffmpeg is missing. */
bool stability_clip(const ClipOptions *options, Error *error);
