/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The trajectory in memory. */
#include "trajectory/trajectory.h"

#include "common/array.h"
#include "common/hash.h"
#include "common/utf8.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

static double measure(double frames, double bodies, double contacts) {
    double pose = 2 * sizeof(Vec2) + 2 * sizeof(float), body = sizeof(Vec2) + 1, small = 4096;
    return frames * (bodies * pose + sizeof(int64_t)) + bodies * body + contacts * sizeof(TrajectoryContact) + small;
}

/* calloc, but not NULL for 0 items. */
static void *zeros(size_t count, size_t size) { return calloc(count > 0 ? count : 1, size); }

static bool allocate(Trajectory *t) {
    size_t bodies = (size_t)t->bodies, poses = (size_t)t->frames * bodies;
    t->size = zeros(bodies, sizeof *t->size);
    t->fixed = zeros(bodies, sizeof *t->fixed);
    t->position = zeros(poses, sizeof *t->position);
    t->angle = zeros(poses, sizeof *t->angle);
    t->velocity = zeros(poses, sizeof *t->velocity);
    t->angular_velocity = zeros(poses, sizeof *t->angular_velocity);
    t->contact_start = zeros((size_t)t->frames + 1, sizeof *t->contact_start);
    return t->size != NULL && t->fixed != NULL && t->position != NULL && t->angle != NULL && t->velocity != NULL &&
           t->angular_velocity != NULL && t->contact_start != NULL;
}

Trajectory *trajectory_create(int frames, int bodies, Error *error) {
    assert(frames >= 1 && bodies >= 0);
    if (measure(frames, bodies, 0) > TRAJECTORY_MAX_BYTES) {
        error_input(error, "trajectory", "%d frames of %d bodies take more than 2 GiB", frames, bodies);
        return NULL;
    }
    Trajectory *t = calloc(1, sizeof *t);
    if (t != NULL)
        *t = (Trajectory){.frames = frames, .bodies = bodies, .bomb = -1, .verdict_frame = -1, .verdict_body = -1};
    if (t == NULL || !allocate(t)) {
        trajectory_destroy(t);
        error_memory(error, "trajectory");
        return NULL;
    }
    for (size_t i = 0; i < (size_t)frames * (size_t)bodies; i++) {
        t->position[i] = t->velocity[i] = vec2(NAN, NAN);
        t->angle[i] = t->angular_velocity[i] = NAN;
    }
    return t;
}

void trajectory_destroy(Trajectory *t) {
    if (t == NULL) return;
    free(t->size);
    free(t->fixed);
    free(t->position);
    free(t->angle);
    free(t->velocity);
    free(t->angular_velocity);
    free(t->contact_start);
    free(t->contacts);
    free(t);
}

void trajectory_judge(Trajectory *t, const char *words, int frame, int body) {
    snprintf(t->verdict, sizeof t->verdict, "%.*s", (int)utf8_cut(words, sizeof t->verdict - 1), words);
    t->verdict_frame = frame;
    t->verdict_body = body;
}

bool trajectory_has(const Trajectory *t, int frame, int body) {
    Vec2 position = t->position[(size_t)frame * (size_t)t->bodies + (size_t)body];
    return isfinite(position.x) && isfinite(position.y);
}

/* Sets contact_start of steps without contacts, from the last step with contacts up to `step`. */
static void end_steps(Trajectory *t, int step, int64_t count) {
    for (int k = t->last_step + 1; k <= step; k++) t->contact_start[k + 1] = count;
    if (step > t->last_step) t->last_step = step;
}

double trajectory_bytes(const Trajectory *t) {
    return measure(t->frames, t->bodies, (double)t->contact_start[t->frames]);
}

TrajectoryContact *trajectory_add_contacts(Trajectory *t, int frame, int added, Error *error) {
    assert(frame >= t->last_step && frame < t->frames && added >= 0);
    int64_t count = t->contact_start[t->last_step + 1];
    if (measure(t->frames, t->bodies, (double)count + added) > TRAJECTORY_MAX_BYTES) {
        error_input(error, "trajectory", "its contacts take more than 2 GiB");
        return NULL;
    }
    void *contacts = t->contacts;
    /* At least one, so that NULL is a failure. */
    if (!array_reserve(&contacts, &t->contact_capacity, (size_t)(count + added) + 1, sizeof *t->contacts)) {
        error_memory(error, "trajectory");
        return NULL;
    }
    t->contacts = contacts;
    end_steps(t, frame, count);
    t->contact_start[frame + 1] = count + added;
    return t->contacts + count;
}

bool trajectory_add_contact(Trajectory *t, int frame, const TrajectoryContact *contact, Error *error) {
    assert(frame >= 1);
    TrajectoryContact *added = trajectory_add_contacts(t, frame, 1, error);
    if (added != NULL) *added = *contact;
    return added != NULL;
}

void trajectory_restart_contacts(Trajectory *t) {
    t->last_step = -1;
    t->contact_start[0] = 0;
}

void trajectory_end_contacts(Trajectory *t) { end_steps(t, t->frames - 1, t->contact_start[t->last_step + 1]); }

uint64_t trajectory_frame_hash(const Trajectory *t, int frame) {
    uint64_t hash = FNV1A64_START;
    for (int body = 0; body < t->bodies; body++) {
        if (t->fixed[body] || !trajectory_has(t, frame, body)) continue;
        size_t i = (size_t)frame * (size_t)t->bodies + (size_t)body;
        float state[] = {t->position[i].x, t->position[i].y, t->angle[i],
                         t->velocity[i].x, t->velocity[i].y, t->angular_velocity[i]};
        hash = hash_fnv1a64(hash, state, sizeof state);
    }
    return hash;
}
