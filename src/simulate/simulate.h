/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Runs a scene with a method and records the trajectory. */
#pragma once
#include "common/progress.h"
#include "scene/scene.h"
#include "simulate/method.h"
#include "trajectory/trajectory.h"

/* Called with the world after every step; frame: number of the step, 1 .. frames. */
typedef struct StepObserver {
    bool (*observe)(void *context, int frame, const World *world, Error *error);
    void *context;
} StepObserver;

typedef struct Recorder Recorder; /* simulate/recorder.h */

/* Who follows a run, in this order; zero-initialise what is left out. */
typedef struct RunWatch {
    Recorder *recorder;            /* of this scene and method */
    const StepObserver *observers; /* [observer_count] */
    int observer_count;
    NetworkFallbacks *fallbacks; /* those of all steps are added */
    const Progress *progress;
} RunWatch;

/* One step of a run. Then adds the bomb or removes the last body, if the scene does so after this step. On failure the
   error names scene and step. */
bool simulate_step(Stepper *stepper, World *world, const Step *step, Error *error);

/* Runs the scene. False with error set if the method cannot be created, a body's state becomes NaN or infinite, an
   observer fails, or progress requests a stop. */
bool simulate_watched(const Scene *scene, const Method *method, const RunWatch *watch, Error *error);

/* The same with one observer. */
bool simulate_observed(const Scene *scene, const Method *method, const StepObserver *observer, Error *error);

/* Runs the scene and records it in memory (simulate/recorder.h records to files). NULL with error set for the same
   reasons, or if memory is short. */
Trajectory *simulate(const Scene *scene, const Method *method, const Progress *progress, Error *error);
