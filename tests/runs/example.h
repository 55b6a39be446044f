/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A small trajectory with everything in it, for the tests of this folder. */
#pragma once
#include "made.h"

#include "runs/trajectory.h"

#include <stdlib.h>
#include <string.h>

enum { EXAMPLE_FRAMES = 4, EXAMPLE_BODIES = 3 };

static inline void example_pose(Trajectory *t, int frame, int body, const float state[6]) {
    int i = frame * t->bodies + body;
    t->position[i] = vec2(state[0], state[1]);
    t->angle[i] = state[2];
    t->velocity[i] = vec2(state[3], state[4]);
    t->angular_velocity[i] = state[5];
}

/* A floor, a box at rest on it with two contacts in step 2, and a bomb that comes in frame 2. The box falls. */
static inline Trajectory *example_trajectory(void) {
    Error error = {0};
    Trajectory *t = trajectory_create(EXAMPLE_FRAMES, EXAMPLE_BODIES, &error);
    if (t == NULL) abort();
    strcpy(t->scene, "ex\xc3\xa4mple");
    strcpy(t->method, "engine");
    t->scene_hash = 0xfedcba9876543210U;
    t->dt = 1.0F / 60;
    t->bomb = 2;
    t->camera_center = vec2(0, 5);
    t->camera_size = vec2(16, 9);
    t->size[0] = vec2(100, 20);
    t->size[1] = t->size[2] = vec2(1, 0.5F);
    t->fixed[0] = 1;
    t->mass[0] = 0, t->mass[1] = 0.5F, t->mass[2] = 50;
    for (int frame = 0; frame < EXAMPLE_FRAMES; frame++) {
        float f = (float)frame;
        example_pose(t, frame, 0, (float[]){0, -10, 0, 0, 0, 0});
        example_pose(t, frame, 1, (float[]){0.1F * f, 0.25F, -0.0F, f, -0.5F, 3e-30F});
        if (frame >= 2) example_pose(t, frame, 2, (float[]){-5 + f, 15, 1.5F, 7.5F, -22.5F, -1});
    }
    for (int side = 0; side < 2; side++) {
        TrajectoryContact contact = {.a = 0, .b = 1, .feature = 0x01020300U + (uint32_t)side};
        contact.point = vec2((float)side, 0.01F);
        contact.normal = vec2(0, 1);
        contact.normal_impulse = 0.5F + (float)side;
        contact.tangent_impulse = -0.25F;
        add_contact(t, 2, contact);
    }
    trajectory_end_contacts(t);
    trajectory_judge(t, "falls at 0.05 s (body 1, ex\xc3\xa4mple)", 3, 1);
    return t;
}
