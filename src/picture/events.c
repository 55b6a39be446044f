/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/events.h"

#include "trajectory/trajectory_states.h"

/* Searches only the frames before the earliest divergence found so far. */
static void find_divergence(Events *events, const Trajectory *const *runs, int other) {
    const Trajectory *a = runs[0], *b = runs[other];
    int frames = a->frames < b->frames ? a->frames : b->frames;
    if (events->divergence >= 0 && events->divergence < frames) frames = events->divergence;
    for (int frame = 0; frame < frames; frame++)
        for (int body = 0; body < a->bodies; body++)
            if (trajectory_state_difference(a, b, frame, body).distance > EVENTS_VISIBLE_DISTANCE) {
                events->divergence = frame, events->run = other, events->body = body;
                return;
            }
}

Events events_find(const Trajectory *const *runs, int count) {
    Events events = {.impact = -1, .divergence = -1, .run = -1, .body = -1};
    char what[256];
    for (int i = 0; i < count && events.impact < 0; i++) events.impact = trajectory_impact(runs[i]);
    for (int i = 1; i < count; i++)
        if (!trajectory_different_worlds(runs[0], runs[i], what, sizeof what)) find_divergence(&events, runs, i);
    return events;
}
