/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact problems of runs of random scenes, with their converged velocities: all impact frames, and some of the frames
   before and after. Steps at rest are left out, as the method does without the network there. */
#pragma once
#include "impact_training/impact_problems.h"

typedef struct Recording {
    uint64_t seed;
    int first, scenes; /* numbers first .. first + scenes - 1 (random_scene.h) */
    /* Makes the solver that runs scene `number`; called from several threads at once. */
    bool (*make_solver)(void *context, int number, ContactSolver *solver, Error *error);
    void *context;
} Recording;

/* Appends the problems in the order of the scenes. Omits problems whose reference does not converge. Same bits for any
   number of threads. */
bool recording_run(const Recording *recording, ImpactProblems *problems, const Progress *progress, Error *error);
