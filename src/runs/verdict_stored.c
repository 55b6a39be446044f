/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The verdict on a stored run. A file has no gravity, and perhaps no masses, contacts and velocities: the first two
   come from a scene or are assumed, the others are found again. */
#include "base/base.h"
#include "engine/engine.h"
#include "runs/trajectory.h"
#include "runs/verdict.h"
#include "scenes/scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* How many bodies a frame has: the first ones, as a watch expects. */
static bool count_bodies(const Trajectory *run, int frame, int *count, Error *error) {
    *count = 0;
    while (*count < run->bodies && trajectory_has(run, frame, *count)) ++*count;
    for (int i = *count + 1; i < run->bodies; i++)
        if (trajectory_has(run, frame, i))
            return error_input(error, run->scene, "frame %d has body %d, but not body %d: such a run has no verdict",
                               frame, i, *count);
    return true;
}

/* A body's state. Of a run without velocities, they are those that lead from or to the neighbouring frame, as
   semi-implicit Euler moves bodies, whichever are slower: what pushes an overlap apart lasts a step. */
static void set_body(const Trajectory *run, int frame, int i, Body *body) {
    const size_t now = trajectory_at(run, frame, i);
    const float rate = 1 / run->dt, whole_turn = 6.2831853f; /* some engines keep angles within one */
    bool known = !run->no_velocities;
    body->position = run->position[now];
    body->angle = run->angle[now];
    body->velocity = run->velocity[now];
    body->angular_velocity = run->angular_velocity[now];
    for (int from = frame - 1; run->no_velocities && from <= frame; from++) {
        if (from < 0 || from + 1 >= run->frames || !trajectory_has(run, from, i) || !trajectory_has(run, from + 1, i))
            continue;
        const size_t a = trajectory_at(run, from, i), b = trajectory_at(run, from + 1, i);
        const Vec2 velocity = vec2_scale(rate, vec2_sub(run->position[b], run->position[a]));
        const float spin = rate * remainderf(run->angle[b] - run->angle[a], whole_turn);
        if (!known || vec2_dot(velocity, velocity) < vec2_dot(body->velocity, body->velocity))
            body->velocity = velocity;
        if (!known || fabsf(spin) < fabsf(body->angular_velocity)) body->angular_velocity = spin;
        known = true;
    }
}

Scene *trajectory_scene(const Trajectory *run, Error *error) {
    Scene *scene = calloc(1, sizeof *scene);
    if (scene != NULL) scene->bodies = calloc((size_t)run->bodies + 1, sizeof *scene->bodies);
    if (scene == NULL || scene->bodies == NULL) {
        free(scene);
        error_memory(error, run->scene);
        return NULL;
    }
    snprintf(scene->name, sizeof scene->name, "%.*s", (int)utf8_cut(run->scene, sizeof scene->name - 1), run->scene);
    scene->gravity = vec2(0, -VERDICT_GRAVITY);
    scene->bomb.present = run->bomb >= 0;
    for (int i = 0; i < run->bodies; i++) {
        const Vec2 size = run->size[i];
        const float mass = trajectory_has_masses(run) ? run->mass[i] : VERDICT_DENSITY * size.x * size.y;
        if (i == run->bomb && i == run->bodies - 1 && !run->fixed[i]) {
            scene->bomb.size = size;
            scene->bomb.mass.value = mass;
            break;
        }
        scene->bodies[scene->body_count++] = (BodyDef){.size = size, .fixed = run->fixed[i], .mass = mass};
    }
    return scene;
}

static bool fits(const Scene *scene, const Trajectory *run, const World *world, Error *error) {
    const Body *bodies = world_bodies(world);
    if (run->bodies != scene->body_count && run->bodies != world_body_count(world))
        return error_input(error, scene->name, "has %d bodies, but the run has %d", scene->body_count, run->bodies);
    for (int i = 0; i < run->bodies; i++)
        if (memcmp(&bodies[i].size, &run->size[i], sizeof *run->size) != 0 ||
            (bodies[i].inv_mass == 0) != (run->fixed[i] != 0))
            return error_input(
                error, scene->name, "is not the scene of the run: body %d is %g x %g m%s, not %g x %g m%s", i,
                (double)run->size[i].x, (double)run->size[i].y, run->fixed[i] ? ", static" : "",
                (double)bodies[i].size.x, (double)bodies[i].size.y, bodies[i].inv_mass == 0 ? ", static" : "");
    return true;
}

/* Each frame is a step, in which the bodies of the world get the poses of the run. */
static bool watch_frames(VerdictWatch *watch, const VerdictRun *judged, const Trajectory *run, const World *world,
                         Error *error) {
    const size_t size = (size_t)run->bodies * sizeof(Body);
    Body *bodies = malloc(size + 1);
    if (bodies == NULL) return error_memory(error, run->scene);
    if (size > 0) memcpy(bodies, world_bodies(world), size);
    bool ok = true;
    for (int frame = 0; ok && frame < run->frames; frame++) {
        VerdictStep step = {.frame = frame, .bodies = bodies};
        ok = count_bodies(run, frame, &step.body_count, error);
        for (int i = 0; ok && i < step.body_count; i++) set_body(run, frame, i, &bodies[i]);
        ok = ok && (frame > 0 ? verdict_watch_step(watch, &step, error)
                              : verdict_watch_begin(watch, judged, bodies, step.body_count, error));
    }
    free(bodies);
    return ok;
}

bool simulate_verdict_of_run(SimulateVerdict *verdict, const RunScene *by, const Trajectory *run, Error *error) {
    Scene *scene = by->scene;
    *verdict = (SimulateVerdict){.scene = scene, .method = run->method};
    scene->dt = run->dt;
    scene->frames = run->frames - 1;
    scene->bomb.present &= run->bomb >= 0 || run->bodies > scene->body_count;
    const VerdictRun judged = {.gravity = scene->gravity,
                               .dt = scene->dt,
                               .bomb = !scene->bomb.present ? -1
                                       : run->bomb >= 0     ? run->bomb
                                                            : scene->body_count,
                               .skin = by->skin,
                               .masses_unknown = by->assumed && !trajectory_has_masses(run),
                               .finds_contacts = true};
    World *world = scene_world(scene, error);
    const bool later = scene->bomb.present && scene->bomb.frame > 0;
    const bool ok = world != NULL && (!later || scene_add_bomb(scene, world, error)) &&
                    fits(scene, run, world, error) && watch_frames(&verdict->watch, &judged, run, world, error);
    world_destroy(world);
    if (!ok) return false;
    /* A run that ended in NaN says so of itself; its frames are finite. */
    const char *ended = verdict_name(VERDICT_NON_FINITE);
    Error failure = {0};
    if (strncmp(run->verdict, ended, strlen(ended)) == 0)
        error_failure(&failure, FAILURE_NOT_FINITE, run->scene, "NaN or infinite");
    return simulate_verdict_end(verdict, &failure);
}
