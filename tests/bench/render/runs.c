/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "runs.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void give_up(const Error *error) {
    fprintf(stderr, "%s\n", error->message);
    exit(3);
}

static Trajectory *looped(const char *path, int frames) {
    Error error = {0};
    Trajectory *run = trajectory_read(path, &error);
    if (run == NULL) give_up(&error);
    Trajectory *loop = trajectory_create(frames, run->bodies, &error);
    if (loop == NULL) give_up(&error);
    memcpy(loop->scene, run->scene, sizeof run->scene);
    memcpy(loop->method, run->method, sizeof run->method);
    memcpy(loop->size, run->size, (size_t)run->bodies * sizeof *run->size);
    memcpy(loop->fixed, run->fixed, (size_t)run->bodies * sizeof *run->fixed);
    loop->dt = run->dt;
    loop->bomb = run->bomb;
    loop->camera_center = run->camera_center;
    loop->camera_size = run->camera_size;
    for (int frame = 0; frame < frames; frame++) {
        size_t to = (size_t)frame * (size_t)run->bodies, from = (size_t)(frame % run->frames) * (size_t)run->bodies;
        for (int body = 0; body < run->bodies; body++, to++, from++) {
            loop->position[to] = run->position[from];
            loop->angle[to] = run->angle[from];
            loop->velocity[to] = run->velocity[from];
            loop->angular_velocity[to] = run->angular_velocity[from];
        }
    }
    trajectory_destroy(run);
    return loop;
}

Job job_read(int argc, char **argv) {
    if (argc < 7) {
        fprintf(stderr, "usage: %s DIR WIDTH HEIGHT FRAMES RUN RUN ...\n", argv[0]);
        exit(2);
    }
    Job job = {.directory = argv[1], .width = atoi(argv[2]), .height = atoi(argv[3]), .frames = atoi(argv[4])};
    for (int i = 0; i < PANELS; i++) job.runs[i] = looped(argv[5 + i], job.frames);
    return job;
}

void job_free(Job *job) {
    for (int i = 0; i < PANELS; i++) trajectory_destroy(job->runs[i]);
}
