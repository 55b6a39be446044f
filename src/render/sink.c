/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/sink.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool write_png(void *context, int frame, const Image *image, const ImageText *texts, int count, Error *error) {
    const char *directory = context;
    size_t size = strlen(directory) + sizeof "/frame_.png" + 16;
    char *path = malloc(size);
    if (path == NULL) return error_memory(error, directory);
    snprintf(path, size, "%s/frame_%06d.png", directory, frame);
    bool ok = image_write_png(image, path, texts, count, error);
    free(path);
    return ok;
}

FrameSink sink_png(const char *directory) { return (FrameSink){write_png, (void *)directory}; }
