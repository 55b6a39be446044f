/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where finished frames go. */
#pragma once
#include "image/image.h"

typedef struct FrameSink {
    bool (*write)(void *context, int frame, const Image *image, const ImageText *texts, int count, Error *error);
    void *context;
} FrameSink;

/* Writes frame_000000.png ... into a directory that is there already; its name must outlive the sink. */
FrameSink sink_png(const char *directory);
