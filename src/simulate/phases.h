/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The phases of a run, counted from the step in which the bomb first touches a box that can move: impact (the scene
   sets the number of frames), the 60 frames after, and all other frames. */
#pragma once
#include "dynamics/contact_problem.h"

typedef enum Phase { PHASE_IMPACT, PHASE_AFTER, PHASE_REST } Phase;

enum { PHASES = PHASE_REST + 1, AFTER_FRAMES = 60 };

typedef struct PhaseTracker {
    int impact_frames; /* the scene's */
    int touch;         /* number of the first step in which the bomb touches; 0: not yet */
} PhaseTracker;

/* The phase of step `frame`, which has this contact problem. Call it for all steps in order. */
Phase phase_next(PhaseTracker *tracker, const ContactProblem *problem, int frame);
