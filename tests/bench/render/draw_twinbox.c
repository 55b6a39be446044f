/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the seconds that a sequence takes with a number of jobs (the last argument), from the call until the files are
   on disk, and the memory (MB) of its largest process. */
#include "runs.h"

#include "pictures/render.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

int main(int argc, char **argv) {
    Job job = job_read(argc - 1, argv);
    Error error = {0};
    RenderOptions options = {
        .width = job.width, .height = job.height, .last = -1, .jobs = atoi(argv[argc - 1]), .directory = job.directory};
    const Trajectory *const panels[PANELS] = {job.runs[0], job.runs[1]};
    double start = clock_seconds();
    if (!render_sequence(panels, PANELS, &options, NULL, NULL, &error)) {
        fprintf(stderr, "%s\n", error.message);
        return 3;
    }
    double seconds = clock_seconds() - start;
    struct rusage usage;
    getrusage(RUSAGE_CHILDREN, &usage);
    printf("%.6f %.1f\n", seconds, (double)usage.ru_maxrss / 1024);
    job_free(&job);
    return 0;
}
