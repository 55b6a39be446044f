/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Playback: replays the velocities of the nearest recorded launch, frame by frame, without physics. A baseline: a
   method has learned something only if it is more accurate.

   It records launches of the training family, solved close to convergence, from the frame of the bomb on. The frames
   before the bomb are the same in all of them and recorded once. The nearest launch has the smallest sum of differences
   in position, rotation, spin and mass of the bomb, each in its own unit. A recording starts at the frame of the bomb,
   whichever that is.

   Fails on launches far from the recorded ones: it does not use the positions of the boxes. */
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The limit of recorded velocities, 600 MB. */
enum { PLAYBACK_MAX_STATES = 50000000 };

static const char recorder[] = "momentum:k=100";

typedef struct Playback {
    int launch_count, bodies;         /* bodies: with the bomb */
    int frames_before, frames;        /* before and after the bomb appears */
    Launch *launches;                 /* [launch_count] */
    BodyVelocity *before;             /* [frames_before, bodies - 1] */
    BodyVelocity *after;              /* [launch_count, frames, bodies] */
    Launch last;                      /* the last launch played back, */
    const BodyVelocity *last_nearest; /* and its nearest recording, [frames, bodies] */
} Playback;

static const SettingSpec settings[] = {{"launches", "recorded launches, spread over the training family (default: 100)",
                                        SETTING_INT(Playback, launch_count, 1, 10000)},
                                       {0}};

static void destroy(void *state) {
    Playback *playback = state;
    free(playback->launches);
    free(playback->before);
    free(playback->after);
    free(playback);
}

/* Steps world from after step `first` - 1 to step `last`; out: [steps, bodies of world]. */
static bool record(Stepper *stepper, World *world, const Scene *scene, int first, int last, BodyVelocity *out,
                   Error *error) {
    for (int frame = first; frame <= last; frame++) {
        const Step step = {.scene = scene, .frame = frame};
        if (!stepper_step(stepper, world, &step, error)) return false;
        const Body *bodies = world_bodies(world);
        for (int i = 0; i < world_body_count(world); i++)
            *out++ = (BodyVelocity){bodies[i].velocity, bodies[i].angular_velocity};
    }
    return true;
}

/* Makes room for the recordings, and makes them. */
static bool fill(Playback *playback, const Scene *scene, Error *error) {
    Method method;
    Scene without = *scene;
    without.bomb.present = false;
    playback->bodies = scene->body_count + 1;
    playback->frames_before = scene->bomb.frame;
    playback->frames = scene->frames - scene->bomb.frame;
    const size_t launches = (size_t)playback->launch_count, size = (size_t)playback->frames * (size_t)playback->bodies,
                 before = (size_t)playback->frames_before * (size_t)scene->body_count;
    if (before + launches * size > PLAYBACK_MAX_STATES)
        return error_input(error, "playback", "%d launches of scene %s are too many to record", playback->launch_count,
                           scene->name);
    playback->launches = calloc(launches, sizeof *playback->launches);
    playback->before = malloc((before + 1) * sizeof *playback->before);
    playback->after = malloc((launches * size + 1) * sizeof *playback->after);
    if (playback->launches == NULL || playback->before == NULL || playback->after == NULL)
        return error_memory(error, "playback");
    if (!launches_for_training(scene, playback->launch_count, playback->launches, error) ||
        !method_parse(&method, recorder, error))
        return false;
    Stepper *stepper = stepper_create(&method, scene, error);
    World *start = scene_world(&without, error), *world = scene_world(&without, error);
    bool ok = stepper != NULL && start != NULL && world != NULL &&
              record(stepper, start, scene, 1, playback->frames_before, playback->before, error);
    for (size_t i = 0; ok && i < launches; i++) {
        const Scene launched = launch_scene(scene, &playback->launches[i]);
        ok = world_copy(world, start, error) && scene_add_bomb(&launched, world, error) &&
             record(stepper, world, &launched, playback->frames_before + 1, scene->frames, playback->after + i * size,
                    error);
    }
    stepper_destroy(stepper);
    world_destroy(start);
    world_destroy(world);
    return ok;
}

static void *create(const Settings *chosen, const Scene *scene, Error *error) {
    static const Playback standard = {.launch_count = 100};
    Playback *playback = settings_make(chosen, settings, &standard, sizeof standard, "playback", error);
    if (playback == NULL) return NULL;
    bool ok = scene->bomb.present && scene->bomb.frame <= scene->frames;
    if (!ok) error_input(error, "playback", "scene %s has no bomb: nothing to play back", scene->name);
    if (ok && fill(playback, scene, error)) return playback;
    destroy(playback);
    return NULL;
}

static float distance(const Launch *a, const Launch *b) {
    return fabsf(a->x - b->x) + fabsf(a->rotation - b->rotation) + fabsf(a->spin - b->spin) + fabsf(a->mass - b->mass);
}

/* The recording nearest to a launch. */
static const BodyVelocity *nearest(Playback *playback, const Launch *launch) {
    if (playback->last_nearest != NULL && memcmp(launch, &playback->last, sizeof *launch) == 0)
        return playback->last_nearest;
    int best = 0;
    for (int i = 1; i < playback->launch_count; i++)
        if (distance(launch, &playback->launches[i]) < distance(launch, &playback->launches[best])) best = i;
    playback->last = *launch;
    playback->last_nearest = playback->after + (size_t)best * (size_t)playback->frames * (size_t)playback->bodies;
    return playback->last_nearest;
}

/* The recorded velocities of a step; after the end of a recording those of its last frame. */
static const BodyVelocity *recorded(Playback *playback, const Step *which, int *bodies) {
    bool before = which->frame <= which->scene->bomb.frame;
    int frame = before ? which->frame : which->frame - which->scene->bomb.frame;
    int frames = before ? playback->frames_before : playback->frames;
    if (frame > frames) frame = frames;
    *bodies = before ? playback->bodies - 1 : playback->bodies;
    if (frame == 0) return NULL;
    const Launch launch = launch_of(which->scene);
    const BodyVelocity *run = before ? playback->before : nearest(playback, &launch);
    return run + (size_t)(frame - 1) * (size_t)*bodies;
}

static bool solve(void *state, BegunStep *begun, Error *error) {
    (void)error;
    int bodies;
    const BodyVelocity *velocities = recorded(state, begun->step, &bodies);
    const ContactSolution *solution = begun->solution;
    for (int i = 0; i < begun->problem->body_count; i++)
        solution->velocities[i] = velocities != NULL && i < bodies ? velocities[i] : (BodyVelocity){{0, 0}, 0};
    for (int i = 0; i < begun->problem->contact_count; i++) solution->impulses[i] = (ContactImpulse){0, 0};
    return true;
}

const SteppingKind stepping_playback = {
    .description = {.name = "playback",
                    .summary = "baseline without physics: replays the velocities of the nearest recorded launch",
                    .caption = "nearest recorded launch",
                    .settings = settings,
                    .role = METHOD_BASELINE,
                    .chart = METHOD_RUNS("launches=25", "launches=100"),
                    .chart_quick = METHOD_RUNS("launches=25"),
                    .stability = METHOD_NO_RUNS},
    .create = create,
    .solve = solve,
    .destroy = destroy};
