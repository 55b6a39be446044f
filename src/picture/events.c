/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/events.h"

#include "trajectory/trajectory_states.h"

/* Looks no further than the earliest found yet. */
static void find_apart(Events *events, const Trajectory *const *runs, int other) {
    const Trajectory *a = runs[0], *b = runs[other];
    int frames = a->frames < b->frames ? a->frames : b->frames;
    if (events->apart >= 0 && events->apart < frames) frames = events->apart;
    for (int frame = 0; frame < frames; frame++)
        for (int body = 0; body < a->bodies; body++)
            if (trajectory_state_difference(a, b, frame, body).distance > EVENTS_APART) {
                events->apart = frame, events->run = other, events->body = body;
                return;
            }
}

Events events_find(const Trajectory *const *runs, int count) {
    Events events = {.impact = -1, .apart = -1, .run = -1, .body = -1};
    char what[256];
    for (int i = 0; i < count && events.impact < 0; i++) events.impact = trajectory_impact(runs[i]);
    for (int i = 1; i < count; i++)
        if (!trajectory_different_worlds(runs[0], runs[i], what, sizeof what)) find_apart(&events, runs, i);
    return events;
}
