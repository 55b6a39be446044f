/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Converts a PNG sequence to a video: H.264, VP9 and GIF by ffmpeg, or raw frames (y4m.h) for other programs. */
#pragma once
#include "render/render.h"

typedef struct VideoOptions {
    const char *directory;       /* of frame_000000.png ... */
    int first, last;             /* pictures, inclusive */
    double frame_rate;           /* Hz */
    const PictureHashes *hashes; /* [last - first + 1], as drawn; NULL: not checked */
    const char *path;            /* ends in .mp4, .webm or .gif */
    bool rate_is_chosen;         /* not just that of the run */
} VideoOptions;

/* Checks name and size of a video. ERROR_INPUT states the reason. */
bool video_check_format(const char *path, int width, int height, Error *error);

/* The same, and creates its folder if missing. ERROR_INPUT or ERROR_SYSTEM. */
bool video_check(const char *path, int width, int height, Error *error);

/* Checks that ffmpeg and ffprobe can be run. */
bool video_check_programs(Error *error);

/* Every picture is decoded and checked here and passed on raw, as ffmpeg skips missing or damaged PNGs. The video's
   frames are counted before the file appears. A GIF is scaled to at most 800 x 800 pixels and shows every n-th
   picture, at most 25 per second: every third of 60 Hz; up to 50, what its time unit allows, if the rate is chosen. */
bool video_encode(const VideoOptions *options, const Progress *progress, Error *error);

/* Writes the same pictures as y4m to an open file; options->path is its name in messages. The output is written in
   place, not renamed when complete. A closed pipe is an error if SIGPIPE is ignored. */
bool video_write_y4m(const VideoOptions *options, int file, const Progress *progress, Error *error);
