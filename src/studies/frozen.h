/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frozen protocol: every method solves the same steps, sampled from engine runs. */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/methods.h"
#include "methods/reference.h"
#include "scenes/scenes.h"
#include "studies/rollout.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct Snapshot {
    const Scene *scene; /* launched; owned by the caller */
    World *world;       /* before the step */
    int frame;          /* of the step */
    Phase phase;
    ReferenceVelocity *reference;   /* [bodies] converged velocities after the step */
    ReferenceVelocity *no_push_out; /* [bodies] the same for methods of that description; or NULL */
} Snapshot;

/* Zero-initialise. */
typedef struct SnapshotList {
    int count;
    Snapshot *items; /* [count] */
    size_t capacity;
    bool no_push_out; /* set by the caller: methods of that description will be scored, too */
    int unconverged;  /* steps that were left out (converged_step_found()) */
} SnapshotList;

/* Adds sampled steps of the engine's run of a launched scene; the scene must outlive the list. */
bool snapshots_add(SnapshotList *list, const Scene *launched, const Sampling *sampling, Error *error);
void snapshots_free(SnapshotList *list);

/* Scores a method on every step. world: scratch space for a copy. A method of the description no_push_out needs a list
   with that flag. */
bool snapshots_score(const SnapshotList *list, Stepper *stepper, World *world, StepScores scores[PHASES], Error *error);
