/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/video_frames.h"

#include "render/sink.h"

#include <limits.h>

static Image *read_frame(const VideoOptions *options, int index, Error *error) {
    char path[PATH_MAX];
    if (!sink_frame_path(path, sizeof path, options->directory, index)) {
        error_input(error, options->directory, "the name is too long");
        return NULL;
    }
    return image_read_png(path, error);
}

bool video_frame_size(const VideoOptions *options, int *width, int *height, Error *error) {
    Image *first = read_frame(options, options->first, error);
    if (first == NULL) return false;
    *width = first->width;
    *height = first->height;
    image_destroy(first);
    return true;
}

static bool check(const VideoOptions *options, int index, const Image *image, int width, int height, Error *error) {
    if (image->width != width || image->height != height)
        return error_input(error, options->directory, "frame %d is %dx%d, but the first is %dx%d", index, image->width,
                           image->height, width, height);
    if (options->hashes != NULL && image_hash(image) != options->hashes[index - options->first].pixels)
        return error_input(error, options->directory, "the pixels of frame %d differ from those drawn", index);
    return true;
}

bool video_feed(const VideoOptions *options, int stride, int width, int height, VideoWrite write_frame, void *context,
                bool *stopped, const Progress *progress, Error *error) {
    *stopped = false;
    for (int index = options->first; !*stopped && index <= options->last; index += stride) {
        Image *image = read_frame(options, index, error);
        bool ok = image != NULL && check(options, index, image, width, height, error);
        if (ok) *stopped = !write_frame(context, image);
        image_destroy(image);
        if (!ok) return false;
        if (!progress_report(progress, index - options->first + 1, options->last - options->first + 1))
            return error_interrupted(error, options->path, "stopped");
    }
    return true;
}
