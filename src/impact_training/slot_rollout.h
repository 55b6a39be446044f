/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs launches of a scene with a given solver and records the contact problems of their impacts: the steps after the
   bomb's first touch in which the residual of the warm start reaches the gate (solvers/residual.h). */
#pragma once
#include "dynamics/contact_solver.h"
#include "impact_training/slot_samples.h"
#include "scene/launch.h"

typedef struct SlotRollout {
    const Scene *scene;
    const Launch *launches; /* [launch_count] */
    int launch_count;       /* the bomb's frame must be the scene's in all launches */
    int first_launch;       /* SlotSample.launch of the first launch */
    int steps;              /* examined from the first touch */
    float gate;             /* m/s */
    /* Makes the solver of one thread; slot_rollout() destroys it. */
    bool (*make_solver)(void *context, ContactSolver *solver, Error *error);
    void *context;
} SlotRollout;

/* Appends to the samples in the order of launches and steps, for any number of threads. A launch ends if its state
   becomes NaN or infinite. */
bool slot_rollout(const SlotRollout *rollout, SlotSamples *samples, const Progress *progress, Error *error);
