/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the programs of this benchmark share. */
#pragma once
#include "trajectory/trajectory.h"

enum { PANELS = 2 };

/* DIR WIDTH HEIGHT FRAMES RUN RUN, and then whatever a program adds. */
typedef struct Job {
    const char *directory;
    int width, height, frames;
    Trajectory *runs[PANELS];
} Job;

/* Reads the arguments. The runs start over as often as it takes to fill the frames. Ends the program on an error. */
Job job_read(int argc, char **argv);
void job_free(Job *job);

double clock_seconds(void);
