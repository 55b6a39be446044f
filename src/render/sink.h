/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where finished frames go. */
#pragma once
#include "image/png_encoder.h"

enum { SINK_NAME_SIZE = 32 };

/* "frame_000012.png", the name of a picture's file. */
void sink_frame_name(char name[SINK_NAME_SIZE], int index);

/* The same with its folder, in `size` bytes; false where there is not room enough. */
bool sink_frame_path(char *path, size_t size, const char *directory, int index);

typedef struct FrameSink {
    /* `changed`: as for png_encode(). *hash: XXH3 of the file. */
    bool (*write)(void *context, int index, const Image *image, const bool *changed, const ImageText *texts, int count,
                  uint64_t *hash, Error *error);
    /* Ends the sink, whatever came before; true when all frames written are safe. */
    bool (*close)(void *context, Error *error);
    void *context;
} FrameSink;

/* Writes frame_000000.png ... into a directory that is there already; its name must outlive the sink. A file is whole
   from the moment it is there, and at the latest by close() it is on the disk. */
bool sink_open_png(FrameSink *sink, const char *directory, int width, int height, PngEffort effort, Error *error);
