/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A process that draws a range of frames. Mesa rasterises one screen at a time in a process, so processes and
   not threads share the work. */
#pragma once
#include "render/picture.h"

typedef struct WorkerJob {
    const Picture *picture;
    const RenderOptions *options;
    int first, last; /* frames, both included */
} WorkerJob;

/* Draws the frames of the job. Writes an Error to the pipe after each (of ERROR_NONE), and the one that ends
   it; an Error is smaller than PIPE_BUF, so it arrives whole. Ends early when nobody listens any more. Runs
   in a process of its own, whose environment it changes. True when all is done. */
bool worker_run(const WorkerJob *job, int pipe);
