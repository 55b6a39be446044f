/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Finished frames as PNG files in a folder. */
#include "base/base.h"
#include "base/file.h"
#include "base/hash.h"
#include "pictures/render.h"
#include "pixels/png.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Bytes; far more than the largest picture file. */
static const size_t MAX_FILE_SIZE = (size_t)1 << 30;

typedef struct PngSink {
    const char *directory;
    PngEncoder *encoder;
    int first, end; /* frames first <= index < end were written here; others in the folder are older */
    size_t path_size;
    char path[]; /* [path_size], for any frame's path */
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
    free(sink);
    return ok;
}

bool sink_open_png(FrameSink *sink, const char *directory, int width, int height, PngEffort effort, Error *error) {
    size_t path_size = strlen(directory) + 1 + SINK_NAME_SIZE;
    PngSink *png = calloc(1, sizeof *png + path_size);
    if (png == NULL) return error_memory(error, directory);
    *png = (PngSink){.directory = directory, .path_size = path_size};
    png->encoder = png_encoder_create(width, height, effort, error);
    *sink = (FrameSink){write_png, close_png, png};
    if (png->encoder != NULL) return true;
    free(png);
    return false;
}
