/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A PNG sequence -> video: H.264, VP9 and GIF by ffmpeg, or raw frames (y4m.h) for programs of the reader's own. */
#pragma once
#include "render/render.h"

typedef struct VideoOptions {
    const char *directory;       /* of frame_000000.png ... */
    int first, last;             /* pictures, both included */
    double frame_rate;           /* Hz */
    const PictureHashes *hashes; /* [last - first + 1], as drawn; NULL: whatever is there counts */
    const char *path;            /* ends in .mp4, .webm or .gif */
} VideoOptions;

/* True where a video may have that name and size: its folder is there, or could be made, no folder has its name.
   ERROR_INPUT or ERROR_SYSTEM says why not. */
bool video_check(const char *path, int width, int height, Error *error);

/* True where ffmpeg and ffprobe can be run. */
bool video_check_programs(Error *error);

/* Every picture is decoded and checked here and handed on raw, since ffmpeg passes over PNGs that are missing or damaged;
   the frames of the video are counted before it is put in place. A GIF, whose frames last whole hundredths of a second,
   and two at least, shows every second picture of 60 Hz. */
bool video_encode(const VideoOptions *options, const Progress *progress, Error *error);

/* The same pictures as y4m into an open file; `path` of the options is its name for messages. Only regular files, pipes
   and the like: it is not put in place whole. A pipe that nobody reads is an error where SIGPIPE is ignored. */
bool video_write_y4m(const VideoOptions *options, int file, const Progress *progress, Error *error);
