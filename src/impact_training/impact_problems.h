/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What schedules are fitted to: contact problems from the engine's runs, from the bomb's first touch on, and their
   converged velocities. */
#pragma once
#include "common/error.h"
#include "common/parse.h"
#include "common/progress.h"
#include "reference/reference.h"
#include "scene/scene.h"

enum { AFTER_STEP = 6 }; /* all frames of the impact (simulate/phases.h), and every so many of those after */

typedef struct ImpactProblem {
    ContactProblem problem; /* with arrays of its own */
    ReferenceVelocity *reference;
    bool impact;
} ImpactProblem;

typedef struct ImpactProblems {
    ImpactProblem *items;
    size_t count, capacity;
} ImpactProblems;

void impact_problems_free(ImpactProblems *problems);

/* Runs every launch. Problems whose reference does not converge are left out. ERROR_INPUT where the scene has no bomb,
   the bomb touches nothing, or progress asks to stop. */
bool impact_problems_record(ImpactProblems *problems, const Scene *scene, const FloatRange *bomb_x,
                            const Progress *progress, Error *error);
