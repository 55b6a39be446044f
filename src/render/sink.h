/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where finished frames go. */
#pragma once
#include "image/png_encoder.h"

typedef struct FrameSink {
    /* `changed`: as for png_encode(). */
    bool (*write)(void *context, int frame, const Image *image, const bool *changed, const ImageText *texts, int count,
                  Error *error);
    /* Ends the sink, whatever came before; true when all frames written are safe. */
    bool (*close)(void *context, Error *error);
    void *context;
} FrameSink;

/* Writes frame_000000.png ... into a directory that is there already; its name must outlive the sink. A file is whole
   from the moment it is there, and at the latest by close() it is on the disk. */
bool sink_open_png(FrameSink *sink, const char *directory, int width, int height, PngEffort effort, Error *error);
