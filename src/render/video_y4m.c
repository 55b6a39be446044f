/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/video_frames.h"

#include "render/y4m.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

typedef struct Y4mTarget {
    int file, cause; /* cause: errno of the failed write */
    size_t size;
    uint8_t *frame;
} Y4mTarget;

static bool write_all(Y4mTarget *target, const void *data, size_t size) {
    for (const char *at = data, *end = at + size; at < end;) {
        ssize_t written = write(target->file, at, (size_t)(end - at));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) {
            target->cause = errno;
            return false;
        }
        at += written;
    }
    return true;
}

static bool write_y4m_frame(void *context, const Image *image) {
    Y4mTarget *target = context;
    y4m_frame(image, target->frame);
    return write_all(target, target->frame, target->size);
}

bool video_write_y4m(const VideoOptions *options, int file, const Progress *progress, Error *error) {
    int width, height;
    char header[Y4M_HEADER_SIZE];
    if (!video_frame_size(options, &width, &height, error)) return false;
    Y4mTarget target = {.file = file, .size = y4m_frame_size(width, height)};
    target.frame = malloc(target.size);
    if (target.frame == NULL) return error_memory(error, options->path);
    y4m_header(header, width, height, options->frame_rate);
    bool stopped = !write_all(&target, header, strlen(header)), ok = true;
    if (!stopped) ok = video_feed(options, 1, width, height, write_y4m_frame, &target, &stopped, progress, error);
    free(target.frame);
    return ok && (!stopped || error_system(error, options->path, "cannot write: %s", strerror(target.cause)));
}
