/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Small synthetic runs. */
#pragma once
#include "made.h"

enum { GROUND_BODY, FIRST_BOX, SECOND_BOX, BOMB_BODY, RUN_BODIES };

static inline Vec2 *run_position(Trajectory *run, int frame, int body) {
    return &run->position[frame * run->bodies + body];
}

static inline float *run_angle(Trajectory *run, int frame, int body) { return &run->angle[frame * run->bodies + body]; }

/* Two boxes on a wide ground, one rotating, and a bomb that appears in frame 2 and falls. */
static inline Trajectory *run_make(const char *method, int frames) {
    static const Vec2 sizes[RUN_BODIES] = {{100, 20}, {1, 1}, {2, 1}, {1.5F, 1.5F}};
    Trajectory *run = run_sized(frames, RUN_BODIES);
    strcpy(run->scene, "two_boxes");
    strcpy(run->method, method);
    run->dt = 1.0F / 60;
    run->bomb = BOMB_BODY;
    run->fixed[GROUND_BODY] = 1;
    memcpy(run->size, sizes, sizeof sizes);
    for (int frame = 0; frame < frames; frame++) {
        const Vec2 positions[RUN_BODIES] = {{0, -10}, {-2, 0.5F}, {2, 0.5F}, {1, 6 - 0.2F * (float)frame}};
        const float angles[RUN_BODIES] = {0, 0, 0.1F * (float)frame, 0.2F};
        for (int body = 0; body < (frame < 2 ? BOMB_BODY : RUN_BODIES); body++) {
            int i = frame * RUN_BODIES + body;
            run->position[i] = positions[body];
            run->angle[i] = angles[body];
            run->velocity[i] = vec2(0, 0);
            run->angular_velocity[i] = 0;
        }
    }
    return run;
}
