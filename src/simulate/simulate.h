/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs a scene with a method and records the trajectory. */
#pragma once
#include "common/progress.h"
#include "scene/scene.h"
#include "simulate/method.h"
#include "trajectory/trajectory.h"

/* The limit of bodies times frames of a trajectory: 24 bytes each, 1.2 GB. */
enum { SIMULATE_MAX_STATES = 50000000 };

/* Called with the world after every step; frame: number of the step, 1 .. frames. */
typedef struct StepObserver {
    bool (*observe)(void *context, int frame, const World *world, Error *error);
    void *context;
} StepObserver;

/* One step of a run. Then adds the bomb or removes the last body, if the scene does so after this step. On failure the
   error names scene and step. */
bool simulate_step(Stepper *stepper, World *world, const Step *step, Error *error);

/* NULL with error set if the method cannot be created, memory is short, a body's state becomes NaN or infinite, or
   progress requests a stop. */
Trajectory *simulate(const Scene *scene, const Method *method, const Progress *progress, Error *error);

/* The same, and adds the fallbacks of all steps to the sum; the observer may be NULL. */
Trajectory *simulate_counting(const Scene *scene, const Method *method, NetworkFallbacks *sum,
                              const StepObserver *observer, const Progress *progress, Error *error);

/* The same run without recording. */
bool simulate_observed(const Scene *scene, const Method *method, const StepObserver *observer, Error *error);
