/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Output of finished frames. */
#pragma once
#include "image/png_encoder.h"

enum { SINK_NAME_SIZE = 32 };

/* "frame_000012.png", the file name of a picture. */
void sink_frame_name(char name[SINK_NAME_SIZE], int index);

/* The same with its folder; false if it does not fit in `size` bytes. */
bool sink_frame_path(char *path, size_t size, const char *directory, int index);

/* *same: whether the file of that picture exists and has these bytes (XXH3). False with error set if the system cannot
   tell. */
bool sink_frame_check(const char *directory, int index, uint64_t hash, bool *same, Error *error);

/* The same; false if the system cannot tell. */
bool sink_frame_is(const char *directory, int index, uint64_t hash);

typedef struct FrameSink {
    /* `changed`: as for png_encode(). *hash: XXH3 of the file. */
    bool (*write)(void *context, int index, const Image *image, const bool *changed, const ImageText *texts, int count,
                  uint64_t *hash, Error *error);
    /* Closes the sink, also after errors; true if all frames are safely stored. */
    bool (*close)(void *context, Error *error);
    void *context;
} FrameSink;

/* Writes frame_000000.png, ... into an existing directory; its name must outlive the sink. Files appear complete and
   are synced to disk by close(). */
bool sink_open_png(FrameSink *sink, const char *directory, int width, int height, PngEffort effort, Error *error);
