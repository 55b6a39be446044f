/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "learning/launch_runs.h"

#include "common/parallel.h"
#include "simulate/simulate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LAUNCH_RUNS_MAX_BYTES = 1 << 30 };

typedef struct Work {
    LaunchRuns *runs;
    const Scene *scene;
    const Method *method;
} Work;

static void record(const LaunchRuns *runs, const World *world, BodyPose *poses) {
    const Body *bodies = world_bodies(world);
    const int count = world_body_count(world);
    for (int i = 0; i < runs->bodies; i++)
        poses[i] = i < count ? (BodyPose){bodies[i].position, bodies[i].angle} : (BodyPose){{NAN, NAN}, NAN};
}

/* A run in progress. */
typedef struct LaunchRun {
    const LaunchRuns *runs;
    BodyPose *poses; /* [frames, bodies] */
} LaunchRun;

static bool observe(void *context, int frame, const World *world, Error *error) {
    (void)error;
    const LaunchRun *run = context;
    record(run->runs, world, run->poses + (size_t)frame * (size_t)run->runs->bodies);
    return true;
}

static bool run_launch(void *context, int i, Error *error) {
    const Work *work = context;
    const LaunchRuns *runs = work->runs;
    LaunchRun run = {runs, runs->poses + (size_t)i * (size_t)runs->frames * (size_t)runs->bodies};
    const StepObserver observer = {observe, &run};
    const Scene launched = launch_scene(work->scene, &runs->launches[i]);
    World *start = scene_world(&launched, error);
    if (start == NULL) return false;
    record(runs, start, run.poses);
    world_destroy(start);
    return simulate_observed(&launched, work->method, &observer, error);
}

bool launch_runs_record(LaunchRuns *runs, const Scene *scene, const Method *method, const Launch *launches, int count,
                        const Progress *progress, Error *error) {
    *runs = (LaunchRuns){.count = count, .frames = scene->frames + 1, .bodies = scene->body_count + 1};
    if (!scene->bomb.present) return error_input(error, scene->name, "the scene has no bomb, so it has no launches");
    const double bytes = (double)count * runs->frames * runs->bodies * (double)sizeof *runs->poses;
    if (bytes > LAUNCH_RUNS_MAX_BYTES)
        return error_input(error, scene->name, "%d launches take %.0f MiB of poses; at most 1024 MiB are allowed",
                           count, bytes / (1 << 20));
    runs->launches = malloc((size_t)count * sizeof *runs->launches);
    runs->poses = malloc((size_t)bytes);
    if (runs->launches == NULL || runs->poses == NULL) return error_memory(error, scene->name);
    memcpy(runs->launches, launches, (size_t)count * sizeof *launches);
    Work work = {runs, scene, method};
    return parallel_for(&(ParallelWork){run_launch, &work}, count, "launches", progress, error);
}

void launch_runs_free(LaunchRuns *runs) {
    free(runs->launches);
    free(runs->poses);
    *runs = (LaunchRuns){0};
}
