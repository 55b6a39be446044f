/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Training data of momentum schedules: contact problems recorded from engine runs, starting at the bomb's first touch,
   with their converged velocities. */
#pragma once
#include "common/error.h"
#include "common/parse.h"
#include "common/progress.h"
#include "reference/reference.h"
#include "scene/scene.h"

#include <stdio.h>

enum { AFTER_STEP = 6 }; /* all impact frames (simulate/phases.h) and every sixth frame after */

typedef struct ImpactProblem {
    ContactProblem problem; /* owns its arrays */
    ReferenceVelocity *reference;
    bool impact;
} ImpactProblem;

typedef struct ImpactProblems {
    ImpactProblem *items;
    size_t count, capacity;
} ImpactProblems;

void impact_problems_free(ImpactProblems *problems);

/* Appends a copy. reference: [body_count]; NULL: left to be filled. False when memory is short. */
bool impact_problems_add(ImpactProblems *problems, const ContactProblem *problem, const ReferenceVelocity *reference,
                         bool impact);

/* Appends the items of `from`, which is empty afterwards. False when memory is short. */
bool impact_problems_move(ImpactProblems *problems, ImpactProblems *from);

/* Runs every launch. Omits problems whose reference does not converge. ERROR_INPUT if the scene has no bomb, no launch
   touches a box, or progress stops the recording. */
bool impact_problems_record(ImpactProblems *problems, const Scene *scene, const FloatRange *bomb_x,
                            const Progress *progress, Error *error);

/* The problems as bytes. Whether writing failed is for the stream to tell. */
void impact_problems_write(const ImpactProblems *problems, FILE *out);

/* Appends what impact_problems_write() wrote. ERROR_INPUT, naming the file `path`, if the bytes are damaged. */
bool impact_problems_read(ImpactProblems *problems, const char *data, size_t size, const char *path, Error *error);
