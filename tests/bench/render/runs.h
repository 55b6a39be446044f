/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared by the programs of this benchmark. */
#pragma once
#include "base/machine.h" /* clock_seconds() */
#include "runs/trajectory.h"

enum { PANELS = 2 };

/* DIR WIDTH HEIGHT FRAMES RUN RUN, then the arguments of one program. */
typedef struct Job {
    const char *directory;
    int width, height, frames;
    Trajectory *runs[PANELS];
} Job;

/* Reads the arguments. Runs repeat until all frames are filled. Ends the program on an error. */
Job job_read(int argc, char **argv);
void job_free(Job *job);
