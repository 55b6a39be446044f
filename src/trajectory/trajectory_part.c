/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "trajectory/trajectory_part.h"

static bool apart(const Trajectory *a, const Trajectory *b, int frame, int body, double tolerance) {
    if (trajectory_same_state(a, b, frame, body)) return false;
    if (tolerance == 0) return true;
    StateDifference by = trajectory_state_difference(a, b, frame, body);
    return !by.in_a || !by.in_b || by.distance > tolerance;
}

/* The first frame from `frame` on in which a body differs. */
static PartedBody find_parted(const Trajectory *a, const Trajectory *b, int frame, int frames, double tolerance) {
    PartedBody parted = {.frame = -1, .body = -1};
    for (; parted.frame < 0 && frame < frames; frame++)
        for (int body = 0; body < a->bodies; body++) {
            if (!apart(a, b, frame, body, tolerance) || parted.bodies++ > 0) continue;
            parted.frame = frame;
            parted.body = body;
            parted.by = trajectory_state_difference(a, b, frame, body);
        }
    return parted;
}

/* The first step up to `last` with a contact that differs. */
static bool find_step(const Trajectory *a, const Trajectory *b, int last, TrajectoryParting *parting, Error *error) {
    parting->step = -1;
    for (int step = 1; parting->step < 0 && step <= last; step++) {
        if (!contact_difference(a, b, step, -1, &parting->contacts, error)) return false;
        if (contacts_differ(&parting->contacts)) parting->step = step;
    }
    return true;
}

/* True if every body that differs has just been added. The previous frames are equal, so one run suffices. */
static bool only_launched(const Trajectory *a, const Trajectory *b, int frame) {
    for (int body = 0; body < a->bodies; body++)
        if (trajectory_has(a, frame - 1, body) && !trajectory_same_state(a, b, frame, body)) return false;
    return true;
}

static PartCause find_cause(const Trajectory *a, const Trajectory *b, const TrajectoryParting *parting) {
    int frame = parting->first.frame;
    const ContactDifference *contacts = &parting->contacts;
    if (frame < 0) return PART_NONE;
    if (frame == 0) return PART_START;
    if (only_launched(a, b, frame)) return PART_LAUNCH;
    if (a->no_contacts || b->no_contacts) return PART_UNKNOWN;
    if (parting->step >= 0 && parting->step < frame) return PART_HIDDEN;
    if (parting->step < 0) return PART_ELSEWHERE;
    return contacts->only_a + contacts->only_b + contacts->moved > 0 ? PART_CONTACTS : PART_SOLVER;
}

bool trajectory_part(const Trajectory *a, const Trajectory *b, double tolerance, TrajectoryParting *parting,
                     Error *error) {
    int frames = a->frames < b->frames ? a->frames : b->frames;
    *parting = (TrajectoryParting){.frames = frames, .poses_only = !trajectory_both_move(a, b)};
    parting->first = find_parted(a, b, 0, frames, 0);
    parting->beyond = parting->first;
    if (tolerance > 0 && parting->first.frame >= 0)
        parting->beyond = find_parted(a, b, parting->first.frame, frames, tolerance);
    int last = parting->first.frame >= 0 ? parting->first.frame : frames - 1;
    bool contacts = !a->no_contacts && !b->no_contacts;
    parting->step = -1;
    if (contacts && !find_step(a, b, last, parting, error)) return false;
    parting->cause = find_cause(a, b, parting);
    const PartedBody *beyond = &parting->beyond;
    return beyond->frame < 1 || !contacts ||
           contact_difference(a, b, beyond->frame, beyond->body, &parting->beyond_contacts, error);
}
