/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs a scene by a method and records the trajectory. */
#pragma once
#include "common/progress.h"
#include "scene/scene.h"
#include "simulate/method.h"
#include "trajectory/trajectory.h"

/* Bodies times frames that one trajectory may hold: 24 bytes each, 1.2 GB. */
enum { SIMULATE_MAX_STATES = 50000000 };

/* Sees the world after every step: frame is the number of the step, 1 .. frames. */
typedef struct StepObserver {
    bool (*observe)(void *context, int frame, const World *world, Error *error);
    void *context;
} StepObserver;

/* One step of a run: the scene's, and the bomb where it comes after this one, or the body that goes. On failure the
   error names scene and step. */
bool simulate_step(Stepper *stepper, World *world, const Step *step, Error *error);

/* NULL with error set when the method cannot be created, memory is short, a body leaves the finite numbers, or
   progress asks to stop. */
Trajectory *simulate(const Scene *scene, const Method *method, const Progress *progress, Error *error);

/* The same run without recording: only the observer sees it. */
bool simulate_observed(const Scene *scene, const Method *method, const StepObserver *observer, Error *error);
