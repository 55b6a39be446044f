/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/sink.h"

#include "common/file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct PngSink {
    const char *directory;
    PngEncoder *encoder;
    char *path; /* room for that of any frame */
    size_t path_size;
    int first, behind; /* frames written: all from the first to the one before `behind` */
} PngSink;

static void name_frame(PngSink *sink, int frame) {
    snprintf(sink->path, sink->path_size, "%s/frame_%06d.png", sink->directory, frame);
}

static bool write_png(void *context, int frame, const Image *image, const bool *changed, const ImageText *texts,
                      int count, Error *error) {
    PngSink *sink = context;
    const uint8_t *data;
    size_t size;
    name_frame(sink, frame);
    if (!png_encode(sink->encoder, image, changed, texts, count, &data, &size, error) ||
        !file_write_soon(sink->path, data, size, error))
        return false;
    if (sink->behind == 0) sink->first = frame;
    sink->behind = frame + 1;
    return true;
}

/* Once for all: the disk takes many files nearly as fast as one. */
static bool close_png(void *context, Error *error) {
    PngSink *sink = context;
    bool ok = true;
    for (int frame = sink->first; ok && frame < sink->behind; frame++) {
        name_frame(sink, frame);
        ok = file_sync(sink->path, error);
    }
    ok = ok && (sink->behind == 0 || file_sync(sink->directory, error));
    png_encoder_destroy(sink->encoder);
    free(sink->path);
    free(sink);
    return ok;
}

bool sink_open_png(FrameSink *sink, const char *directory, int width, int height, PngEffort effort, Error *error) {
    size_t path_size = strlen(directory) + sizeof "/frame_.png" + 16;
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
