/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/trajectory.h"

#include <assert.h>
#include <string.h>

static void copy_frame(Trajectory *to, int to_frame, const Trajectory *from, int from_frame) {
    size_t bodies = (size_t)from->bodies, to_at = (size_t)to_frame * bodies, at = (size_t)from_frame * bodies;
    memcpy(to->position + to_at, from->position + at, bodies * sizeof *to->position);
    memcpy(to->angle + to_at, from->angle + at, bodies * sizeof *to->angle);
    memcpy(to->velocity + to_at, from->velocity + at, bodies * sizeof *to->velocity);
    memcpy(to->angular_velocity + to_at, from->angular_velocity + at, bodies * sizeof *to->angular_velocity);
}

/* The verdict's frame may have been left out; what it saw is there in the next one. */
static int kept_frame(const Trajectory *to, int frame, int step) {
    const int kept = frame / step + (frame % step != 0);
    return frame >= 0 && kept < to->frames ? kept : -1;
}

static void copy_head(Trajectory *to, const Trajectory *from, int step) {
    memcpy(to->scene, from->scene, sizeof to->scene);
    memcpy(to->method, from->method, sizeof to->method);
    to->scene_hash = from->scene_hash;
    to->iterations = from->iterations;
    to->dt = from->dt * (float)step;
    to->bomb = from->bomb;
    trajectory_judge(to, from->verdict, kept_frame(to, from->verdict_frame, step), from->verdict_body);
    to->no_velocities = from->no_velocities;
    to->no_contacts = from->no_contacts;
    to->camera_center = from->camera_center;
    to->camera_size = from->camera_size;
    memcpy(to->size, from->size, (size_t)from->bodies * sizeof *to->size);
    memcpy(to->fixed, from->fixed, (size_t)from->bodies * sizeof *to->fixed);
}

Trajectory *trajectory_every(const Trajectory *from, int step, Error *error) {
    assert(step >= 1);
    Trajectory *to = trajectory_create((from->frames - 1) / step + 1, from->bodies, error);
    if (to == NULL) return NULL;
    copy_head(to, from, step);
    bool ok = true;
    for (int frame = 0; frame < to->frames; frame++) {
        copy_frame(to, frame, from, frame * step);
        for (int64_t i = from->contact_start[frame * step]; ok && i < from->contact_start[frame * step + 1]; i++)
            ok = trajectory_add_contact(to, frame, &from->contacts[i], error);
    }
    trajectory_end_contacts(to);
    if (ok) return to;
    trajectory_destroy(to);
    return NULL;
}
