/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads back and checks the pictures of a video, one after another. */
#pragma once
#include "image/image.h"
#include "render/video.h"

/* Consumes a picture; false if it needs no more. */
typedef bool (*VideoWrite)(void *context, const Image *image);

/* The size of the first picture, which all must have. */
bool video_frame_size(const VideoOptions *options, int *width, int *height, Error *error);

/* Passes every stride-th picture to `write_frame`, after checking its size and pixels. Sets *stopped if it returned
   false. */
bool video_feed(const VideoOptions *options, int stride, int width, int height, VideoWrite write_frame, void *context,
                bool *stopped, const Progress *progress, Error *error);
