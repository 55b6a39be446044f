/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs launches of a scene by some solver and keeps the contact problems of their impacts: those steps after the bomb's
   first touch in which the cached start is far off (solvers/impact_gap.h). */
#pragma once
#include "dynamics/contact_solver.h"
#include "impact_training/slot_samples.h"
#include "scene/launch.h"

typedef struct SlotRollout {
    const Scene *scene;
    const Launch *launches; /* [launch_count] */
    int launch_count;       /* all with the scene's own frame of the bomb */
    int first_launch;       /* number that the first gets in the samples */
    int steps;              /* that are looked at from the touch on */
    float gate;             /* m/s */
    /* Makes a solver for one thread; solvers are destroyed by their kind. */
    bool (*make_solver)(void *context, ContactSolver *solver, Error *error);
    void *context;
} SlotRollout;

/* Appends to the samples, in the order of launches and steps, whatever the number of threads. A run that leaves the
   finite numbers ends there. */
bool slot_rollout(const SlotRollout *rollout, SlotSamples *samples, const Progress *progress, Error *error);
