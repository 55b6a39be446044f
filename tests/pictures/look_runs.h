/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Three diverging runs with contacts, for tests of what pictures show. Include testing.h first. */
#pragma once
#include "pictures/render.h"
#include "runs.h"

enum { FRAMES = 40, RUNS = 3, WIDTH = 420, HEIGHT = 300, ALL_SHOWN = (1 << SHOW_COUNT) - 1 };

static Trajectory *runs[RUNS];
static const Trajectory *panels[RUNS];

/* The second run diverges from the first in frame 5, the third collapses; the bomb touches a box in frame 20. */
FIXTURE(make) {
    static const char *const methods[RUNS] = {"engine", "momentum:k=20", "pair-net"};
    for (int i = 0; i < RUNS; i++) {
        panels[i] = runs[i] = run_make(methods[i], FRAMES);
        for (int frame = 0; frame < FRAMES; frame++) {
            if (i == 1 && frame >= 5) run_position(runs[i], frame, FIRST_BOX)->x += 0.002F * (float)(frame - 4);
            if (i == 2) *run_position(runs[i], frame, SECOND_BOX) = vec2(2 + 0.2F * (float)frame, 0.5F);
            runs[i]->velocity[frame * RUN_BODIES + BOMB_BODY] = vec2(0, -12);
            TrajectoryContact contact = {.a = FIRST_BOX, .b = frame < 20 ? SECOND_BOX : BOMB_BODY};
            contact.point = vec2(0, 1), contact.normal = vec2(0, 1);
            contact.normal_impulse = (float)frame, contact.tangent_impulse = 0.5F;
            if (frame > 0) add_contact(runs[i], frame, contact);
        }
        trajectory_end_contacts(runs[i]);
    }
}

FIXTURE(destroy) {
    for (int i = 0; i < RUNS; i++) trajectory_destroy(runs[i]);
}
