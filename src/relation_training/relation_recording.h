/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs launches of a scene with a given solver and records contact problems with their converged velocities: all impact
   frames, and some of those after and of those at rest. */
#pragma once
#include "common/progress.h"
#include "dynamics/contact_solver.h"
#include "impact_training/impact_problems.h"
#include "scene/launch.h"

typedef struct RelationRecording {
    const Scene *scene;
    const Launch *launches; /* [count] */
    int count;
    /* Makes the solver of launch i; the recording destroys it. */
    bool (*make_solver)(void *context, int i, ContactSolver *solver, Error *error);
    void *context;
} RelationRecording;

/* Appends to the problems in the order of launches and frames, for any number of threads. Omits problems whose
   reference does not converge. A launch ends 60 frames after its impact, or if its state becomes NaN or infinite. */
bool relation_record(const RelationRecording *recording, ImpactProblems *problems, const Progress *progress,
                     Error *error);
