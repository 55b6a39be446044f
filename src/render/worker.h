/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A process that draws a range of pictures. Mesa rasterises one screen at a time in a process, so processes and
   not threads share the work. */
#pragma once
#include "render/manifest.h"

#include <limits.h>

typedef struct WorkerJob {
    const Picture *picture;
    const RenderOptions *options;
    const MomentPlan *plan;
    const Manifest *manifest; /* of an earlier call: pictures that it knows and that are still so are not drawn */
    int first, last;          /* pictures, both included */
} WorkerJob;

/* What a worker writes to its pipe: of each picture, and the error that ends it. */
typedef struct WorkerReport {
    Error error; /* ERROR_NONE: the picture is there */
    int index;
    bool kept; /* it was there before */
    PictureHashes hashes;
} WorkerReport;

_Static_assert(sizeof(WorkerReport) <= PIPE_BUF, "a report arrives whole");

/* Draws the pictures of the job. Ends early when nobody listens any more. Runs in a process of its own, whose environment
   it changes. True when all is done. */
bool worker_run(const WorkerJob *job, int pipe);
