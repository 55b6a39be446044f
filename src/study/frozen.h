/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frozen protocol: every method takes the same steps, sampled from the engine's runs. */
#pragma once
#include "study/rollout.h"

typedef struct Snapshot {
    const Scene *scene; /* launched; the caller's */
    World *world;       /* before the step */
    int frame;          /* of the step */
    Phase phase;
    ReferenceVelocity *reference; /* [bodies] converged end velocities */
} Snapshot;

/* Zero-initialise. */
typedef struct SnapshotList {
    int count;
    Snapshot *items; /* [count] */
    size_t capacity;
    double residual; /* m/s: the largest of the reference solves */
} SnapshotList;

/* Adds sampled steps of the engine's run of a launched scene, which must outlive the list. */
bool snapshots_add(SnapshotList *list, const Scene *launched, const Sampling *sampling, Error *error);
void snapshots_free(SnapshotList *list);

/* Takes every step with a method. world: work space. */
bool snapshots_score(const SnapshotList *list, Stepper *stepper, World *world, StepScores scores[PHASES], Error *error);
