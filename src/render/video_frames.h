/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of a video, read back and checked, one after the other. */
#pragma once
#include "image/image.h"
#include "render/video.h"

/* Takes a picture; false where no more are wanted. */
typedef bool (*VideoPut)(void *context, const Image *image);

/* The size of all pictures: that of the first. */
bool video_frame_size(const VideoOptions *options, int *width, int *height, Error *error);

/* Puts every so many pictures from the first on, each whole, of this size and as it was drawn. *stopped is set where no
   more were wanted. */
bool video_feed(const VideoOptions *options, int every, int width, int height, VideoPut put, void *context,
                bool *stopped, const Progress *progress, Error *error);
