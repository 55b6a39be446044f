/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A process that draws a range of pictures. Processes rather than threads, as Mesa rasterises one screen at a time
   per process. */
#pragma once
#include "render/manifest.h"

typedef struct WorkerJob {
    const Picture *picture;
    const RenderOptions *options;
    const MomentPlan *plan;
    Manifest *manifest; /* known pictures whose files are unchanged are kept */
    int first, last;    /* pictures, inclusive */
} WorkerJob;

/* What a worker writes to its pipe: one report per picture, or a final one with an error. */
typedef struct WorkerReport {
    Error error; /* ERROR_NONE: the picture is finished */
    int index;
    bool kept; /* the file is of an earlier call */
    PictureHashes hashes;
} WorkerReport;

/* Draws the pictures of the job; ends early if the pipe is closed. Runs in its own process and changes its
   environment. Returns true if all pictures are finished. */
bool worker_run(const WorkerJob *job, int pipe);
