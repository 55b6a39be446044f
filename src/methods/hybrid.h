/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The method hybrid with a memory that its caller fills, for learning. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/hybrid_memory.h"
#include "methods/methods.h"

#include <stdbool.h>

/* A step that asked the memory. */
typedef struct HybridStep {
    const ContactProblem *problem;
    const ContactSolution *solution;
    HybridQuery query;   /* key NULL if there is no memory */
    const float *bomb;   /* [6] its numbers */
    const float *others; /* [6 (body_count - 1)] the numbers of the bodies but the bomb */
    int entry;           /* that answered, or -1: solved to convergence */
} HybridStep;

/* Called after each such step; false with error set stops the step. */
typedef struct HybridWatch {
    bool (*see)(void *context, const HybridStep *step, Error *error);
    void *context;
} HybridWatch;

/* m/s: the gate, RMS residual of the warm start, where no memory sets it. As in scene-net: below it at rest, above
   during a shock. */
extern const float hybrid_gate;

/* memory: the caller's, or NULL: no step is answered. It must outlive the solver, and may grow between launches. watch:
   or NULL. */
bool hybrid_make(ContactSolver *solver, const HybridMemory *memory, const HybridWatch *watch, Error *error);

/* The answer of an entry: impulses clamped to their friction cones, and the velocities that follow; adds to
   fallbacks.outside_cone. The problem has the entry's contacts. */
void hybrid_answer(const HybridMemory *memory, int entry, const float *key, const ContactProblem *problem,
                   ContactSolution *solution);
