/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "common/hash.h"
#include "trajectory/trajectory.h"

static uint64_t add(uint64_t hash, const void *data, size_t size) {
    uint64_t parts[] = {hash, hash_xxh3(data, size)};
    return hash_xxh3(parts, sizeof parts);
}

uint64_t trajectory_hash(const Trajectory *run) {
    size_t bodies = (size_t)run->bodies, poses = bodies * (size_t)run->frames;
    uint64_t hash = add(0, run->size, bodies * sizeof *run->size);
    hash = add(hash, run->fixed, bodies * sizeof *run->fixed);
    hash = add(hash, &run->camera_center, sizeof run->camera_center);
    hash = add(hash, &run->camera_size, sizeof run->camera_size);
    hash = add(hash, run->position, poses * sizeof *run->position);
    hash = add(hash, run->angle, poses * sizeof *run->angle);
    hash = add(hash, run->velocity, poses * sizeof *run->velocity);
    hash = add(hash, run->angular_velocity, poses * sizeof *run->angular_velocity);
    hash = add(hash, run->contact_start, ((size_t)run->frames + 1) * sizeof *run->contact_start);
    return add(hash, run->contacts, (size_t)run->contact_start[run->frames] * sizeof *run->contacts);
}
