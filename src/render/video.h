/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A PNG sequence -> H.264 video (ffmpeg). */
#pragma once
#include "common/error.h"
#include "common/progress.h"

typedef struct VideoOptions {
    const char *directory; /* of frame_000000.png ... */
    int first, last;       /* frames, both included */
    double frame_rate;     /* Hz */
    const char *path;      /* ends in .mp4 */
} VideoOptions;

/* True where a video may have that name and size; else the error says why not. */
bool video_check(const char *path, int width, int height, Error *error);

/* Every frame is decoded here and handed on raw, since ffmpeg passes over PNGs that are missing or damaged;
   the frames of the video are counted before it is put in place. */
bool video_encode(const VideoOptions *options, const Progress *progress, Error *error);
