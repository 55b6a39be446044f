/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact problems that runs have recorded, with their converged velocities. */
#pragma once
#include "reference/reference.h"

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

/* Appends a copy. reference: [body_count]. False when memory is short. */
bool impact_problems_add(ImpactProblems *problems, const ContactProblem *problem, const ReferenceVelocity *reference,
                         bool impact);

/* Appends the items of `from`, which is empty afterwards. False when memory is short. */
bool impact_problems_move(ImpactProblems *problems, ImpactProblems *from);
