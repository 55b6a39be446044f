/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "simulate/phases.h"

#include <stdbool.h>

static bool bomb_touches(const ContactProblem *problem) {
    for (int i = 0; problem->marked >= 0 && i < problem->contact_count; i++) {
        const ContactPoint *contact = &problem->contacts[i];
        bool bomb = contact->a == problem->marked || contact->b == problem->marked;
        if (bomb && problem->bodies[contact->a].inv_mass > 0 && problem->bodies[contact->b].inv_mass > 0) return true;
    }
    return false;
}

Phase phase_next(PhaseTracker *tracker, const ContactProblem *problem, int frame) {
    if (tracker->touch == 0 && bomb_touches(problem)) tracker->touch = frame;
    if (tracker->touch == 0) return PHASE_REST;
    int since = frame - tracker->touch;
    if (since < tracker->impact_frames) return PHASE_IMPACT;
    return since < tracker->impact_frames + AFTER_FRAMES ? PHASE_AFTER : PHASE_REST;
}
