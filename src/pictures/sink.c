/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/machine.h"
#include "pictures/render.h"
#include "pictures/render_internal.h"
#include "pixels/png.h"

#include <errno.h>
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char frame_line[] = "FRAME\n";
enum { FRAME_LINE_SIZE = sizeof frame_line - 1 };

void y4m_header(char header[Y4M_HEADER_SIZE], int width, int height, double frame_rate) {
    const int64_t rate = (int64_t)(1000 * frame_rate + 0.5), divisor = greatest_divisor(rate, 1000);
    snprintf(header, Y4M_HEADER_SIZE, "YUV4MPEG2 W%d H%d F%" PRId64 ":%" PRId64 " Ip A1:1 C444 XCOLORRANGE=LIMITED\n",
             width, height, rate / divisor, 1000 / divisor);
}

size_t y4m_frame_size(int width, int height) { return FRAME_LINE_SIZE + 3 * (size_t)width * (size_t)height; }

/* a / b rounded to the nearest integer; b > 0 and even. */
static int nearest(int a, int b) { return (a + b / 2 + 256 * b) / b - 256; }

void y4m_frame(const Image *image, uint8_t *frame) {
    size_t pixels = (size_t)image->width * (size_t)image->height;
    uint8_t *y = (uint8_t *)memcpy(frame, frame_line, FRAME_LINE_SIZE) + FRAME_LINE_SIZE, *cb = y + pixels,
            *cr = cb + pixels;
    for (size_t i = 0; i < pixels; i++) {
        const uint8_t *rgb = image->pixels + 4 * i;
        /* In 1/10000 of a channel's step. */
        int light = 2126 * rgb[0] + 7152 * rgb[1] + 722 * rgb[2];
        y[i] = (uint8_t)(16 + nearest(219 * light, 255 * 10000));
        cb[i] = (uint8_t)(128 + nearest(224 * (10000 * rgb[2] - light), 255 * 18556));
        cr[i] = (uint8_t)(128 + nearest(224 * (10000 * rgb[0] - light), 255 * 15748));
    }
}

/* Bytes; far more than the largest picture file. */
static const size_t MAX_FILE_SIZE = (size_t)1 << 30;

typedef struct PngSink {
    const char *directory;
    PngEncoder *encoder;
    char *path; /* buffer for any frame's path */
    size_t path_size;
    int first, end; /* frames first <= index < end were written here; others in the folder are older */
} PngSink;

void sink_frame_name(char name[SINK_NAME_SIZE], int index) { snprintf(name, SINK_NAME_SIZE, "frame_%06d.png", index); }

bool sink_frame_path(char *path, size_t size, const char *directory, int index) {
    char name[SINK_NAME_SIZE];
    sink_frame_name(name, index);
    return snprintf(path, size, "%s/%s", directory, name) < (int)size;
}

bool sink_frame_check(const char *directory, int index, uint64_t hash, bool *same, Error *error) {
    char path[PATH_MAX];
    size_t size;
    Error reason = {0};
    *same = false;
    if (!sink_frame_path(path, sizeof path, directory, index)) return true;
    char *data = file_read(path, MAX_FILE_SIZE, &size, &reason);
    *same = data != NULL && hash_xxh3(data, size) == hash;
    free(data);
    if (data != NULL || reason.kind == ERROR_INPUT) return true;
    *error = reason;
    return false;
}

bool sink_frame_is(const char *directory, int index, uint64_t hash) {
    bool same;
    return sink_frame_check(directory, index, hash, &same, &(Error){0}) && same;
}

static bool write_png(void *context, int index, const Image *image, const bool *changed, const ImageText *texts,
                      int count, uint64_t *hash, Error *error) {
    PngSink *sink = context;
    const uint8_t *data;
    size_t size;
    sink_frame_path(sink->path, sink->path_size, sink->directory, index);
    if (!png_encode(sink->encoder, image, changed, texts, count, &data, &size, error) ||
        !file_write_soon(sink->path, data, size, error))
        return false;
    *hash = hash_xxh3(data, size);
    if (sink->end == 0) sink->first = index;
    sink->end = index + 1;
    return true;
}

/* Once, at the end: syncing many files takes hardly longer than one. */
static bool close_png(void *context, Error *error) {
    PngSink *sink = context;
    bool ok = true;
    for (int index = sink->first; ok && index < sink->end; index++) {
        sink_frame_path(sink->path, sink->path_size, sink->directory, index);
        ok = file_sync(sink->path, error);
    }
    ok = ok && (sink->end == 0 || file_sync(sink->directory, error));
    png_encoder_destroy(sink->encoder);
    free(sink->path);
    free(sink);
    return ok;
}

bool sink_open_png(FrameSink *sink, const char *directory, int width, int height, PngEffort effort, Error *error) {
    size_t path_size = strlen(directory) + 1 + SINK_NAME_SIZE;
    PngSink *png = calloc(1, sizeof *png);
    char *path = malloc(path_size);
    PngEncoder *encoder = png_encoder_create(width, height, effort, error);
    if (png != NULL && path != NULL && encoder != NULL) {
        *png = (PngSink){.directory = directory, .encoder = encoder, .path = path, .path_size = path_size};
        *sink = (FrameSink){write_png, close_png, png};
        return true;
    }
    png_encoder_destroy(encoder);
    free(path);
    free(png);
    return error_memory(error, directory);
}

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
    const size_t size = y4m_frame_size(width, height);
    uint8_t *frame = malloc(size);
    Y4mTarget target = {.file = file, .size = size, .frame = frame};
    if (frame == NULL) return error_memory(error, options->path);
    y4m_header(header, width, height, options->frame_rate);
    bool stopped = !write_all(&target, header, strlen(header)), ok = true;
    if (!stopped) ok = video_feed(options, 1, width, height, write_y4m_frame, &target, &stopped, progress, error);
    free(frame);
    return ok && (!stopped || error_system(error, options->path, "cannot write: %s", strerror(target.cause)));
}
