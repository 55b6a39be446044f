/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "player/state_chunk.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COMPONENTS = 6, POSES = 3 }; /* velocities first, then poses */

static float component(const Trajectory *run, size_t i, int which) {
    switch (which) {
    case 0: return run->velocity[i].x;
    case 1: return run->velocity[i].y;
    case 2: return run->angular_velocity[i];
    case 3: return run->position[i].x;
    case 4: return run->position[i].y;
    default: return run->angle[i];
    }
}

static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

/* A NaN has no bits that all machines agree on: then the value before is the prediction. */
static uint32_t predict_pose(float before, float velocity, float dt) {
    const float after = before + dt * velocity;
    return bits_of(isnan(after) ? before : after);
}

static void put_component(uint8_t *planes, const Trajectory *run, const PlayerFrames *frames, int begin, int end,
                          int which) {
    const size_t bodies = (size_t)run->bodies, length = (size_t)(end - begin), count = bodies * length;
    const float dt = player_dt(frames, run);
    for (size_t body = 0; body < bodies; body++)
        for (size_t k = 0; k < length; k++) {
            const size_t at = (size_t)player_frame(frames, begin + (int)k) * bodies + body;
            const size_t before = at - (size_t)frames->every * bodies;
            uint32_t predicted = 0;
            if (k > 0 && which < POSES) predicted = bits_of(component(run, before, which));
            if (k > 0 && which >= POSES)
                predicted = predict_pose(component(run, before, which), component(run, at, which - POSES), dt);
            bytes_put(planes, count, body * length + k, bytes_zigzag(bits_of(component(run, at, which)) - predicted));
        }
}

bool state_chunk(Bytes *chunk, const Trajectory *run, const PlayerFrames *frames, int begin, int end, Error *error) {
    const size_t size = (size_t)run->bodies * (size_t)(end - begin) * sizeof(float);
    uint8_t *planes = malloc(COMPONENTS * size + 1);
    if (planes == NULL) return error_memory(error, "page");
    for (int which = 0; which < COMPONENTS; which++)
        put_component(planes + (size_t)which * size, run, frames, begin, end, which);
    const bool ok = bytes_deflate(chunk, planes, COMPONENTS * size, error);
    free(planes);
    return ok;
}
