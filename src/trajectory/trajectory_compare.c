/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where two trajectories differ. */
#include "trajectory/trajectory_states.h"

#include <math.h>

static void describe_first(const Trajectory *a, const Trajectory *b, int frame, int body, TrajectoryDifference *d) {
    d->frame = frame;
    d->body = body;
    StateDifference state = trajectory_state_difference(a, b, frame, body);
    if (!state.in_a || !state.in_b)
        snprintf(d->what, sizeof d->what, "body %d exists in frame %d of the %s only", body, frame,
                 state.in_a ? "first" : "second");
    d->distance = state.distance;
    d->angle = state.angle;
    d->speed = state.speed;
}

void trajectory_compare(const Trajectory *a, const Trajectory *b, TrajectoryDifference *d) {
    *d = (TrajectoryDifference){.frame = -1, .body = -1, .max_frame = -1, .max_body = -1};
    d->poses_only = !trajectory_both_move(a, b);
    if (trajectory_different_worlds(a, b, d->what, sizeof d->what)) return;
    int frames = a->frames < b->frames ? a->frames : b->frames;
    for (int frame = 0; frame < frames; frame++) {
        for (int body = 0; body < a->bodies; body++) {
            if (trajectory_same_state(a, b, frame, body)) continue;
            if (d->frame < 0) describe_first(a, b, frame, body, d);
            double apart = trajectory_state_difference(a, b, frame, body).distance;
            if (!(apart > d->max_distance)) continue;
            d->max_distance = apart;
            d->max_frame = frame;
            d->max_body = body;
        }
    }
    if (d->frame < 0 && a->frames != b->frames)
        snprintf(d->what, sizeof d->what, "frames: %d and %d", a->frames, b->frames);
    d->equal = d->frame < 0 && d->what[0] == '\0';
}

double trajectory_distance(const Trajectory *a, const Trajectory *b, int frame) {
    int bodies = a->bodies < b->bodies ? a->bodies : b->bodies;
    double largest = 0;
    for (int body = 0; body < bodies; body++)
        largest = fmax(largest, trajectory_state_difference(a, b, frame, body).distance);
    return largest;
}
