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

static const char *kind_of(bool fixed) { return fixed ? ", static" : ""; }

/* What a body is: by the run, and by the scene, if it is known. */
static bool describe_body(const Trajectory *run, int i, const Scene *scene, Body *body, Error *error) {
    const Vec2 size = run->size[i];
    BodyDef def = {.size = size, .fixed = run->fixed[i] != 0, .mass = VERDICT_DENSITY * size.x * size.y};
    if (scene != NULL) def = i < scene->body_count ? scene->bodies[i] : scene_bomb_body(scene);
    if (memcmp(&def.size, &size, sizeof size) != 0 || def.fixed != (run->fixed[i] != 0))
        return error_input(error, scene->name, "is not the scene of the run: body %d is %g x %g m%s, not %g x %g m%s",
                           i, (double)size.x, (double)size.y, kind_of(run->fixed[i] != 0), (double)def.size.x,
                           (double)def.size.y, kind_of(def.fixed));
    const float mass = trajectory_has_masses(run) ? run->mass[i] : def.mass;
    *body = (Body){.size = size};
    if (def.fixed) return true;
    body->inv_mass = 1 / mass;
    body->inv_inertia = 12 / (mass * vec2_dot(size, size));
    return true;
}

/* Each frame is a step, in which the bodies get the poses of the run. */
static bool watch_frame(VerdictWatch *watch, const VerdictRun *judged, const Trajectory *run, int frame, Body *bodies,
                        Error *error) {
    int count = 0;
    for (int i = 0; i < run->bodies; i++) {
        if (!trajectory_has(run, frame, i)) continue;
        if (i > count)
            return error_input(error, run->scene, "frame %d has body %d, but not body %d: such a run has no verdict",
                               frame, i, count);
        set_body(run, frame, i, &bodies[count++]);
    }
    if (frame == 0) return verdict_watch_begin(watch, judged, bodies, count, error);
    return verdict_watch_step(watch, &(VerdictStep){.frame = frame, .body_count = count, .bodies = bodies}, error);
}

bool simulate_verdict_of_run(SimulateVerdict *verdict, const Trajectory *run, const Scene *scene, float skin,
                             Error *error) {
    const bool bomb_comes = scene != NULL && scene->bomb.present && run->bodies == scene->body_count + 1;
    const VerdictRun judged = {.gravity = scene != NULL ? scene->gravity : vec2(0, -VERDICT_GRAVITY),
                               .dt = run->dt,
                               .bomb = bomb_comes ? scene->body_count : run->bomb,
                               .skin = skin,
                               .masses_unknown = scene == NULL && !trajectory_has_masses(run),
                               .finds_contacts = true};
    *verdict = (SimulateVerdict){.scene = run->scene, .method = run->method};
    if (scene != NULL && run->bodies != scene->body_count && !bomb_comes)
        return error_input(error, scene->name, "has %d bodies, but the run has %d", scene->body_count, run->bodies);
    Body *bodies = malloc((size_t)run->bodies * sizeof *bodies + 1);
    bool ok = bodies != NULL || error_memory(error, run->scene);
    for (int i = 0; ok && i < run->bodies; i++) ok = describe_body(run, i, scene, &bodies[i], error);
    for (int frame = 0; ok && frame < run->frames; frame++)
        ok = watch_frame(&verdict->watch, &judged, run, frame, bodies, error);
    free(bodies);
    if (!ok) return false;
    /* A run that ended in NaN says so of itself; its frames are finite. */
    const char *ended = verdict_name(VERDICT_NON_FINITE);
    Error failure = {0};
    if (strncmp(run->verdict, ended, strlen(ended)) == 0)
        error_failure(&failure, FAILURE_NOT_FINITE, run->scene, "NaN or infinite");
    return simulate_verdict_end(verdict, &failure);
}
