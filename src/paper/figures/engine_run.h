/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run of the engine, step by step, for figures that need a step's contact problem. */
#pragma once
#include "collision/manifold.h"
#include "simulate/phases.h"
#include "simulate/simulate.h"

typedef struct EngineRun {
    const Scene *scene; /* with the launch; owned by the caller */
    World *world;
    Stepper *stepper;
    int frame; /* of the last step; 0: no step yet */
    PhaseTracker tracker;
} EngineRun;

/* On failure nothing is to be ended. */
bool engine_run_begin(EngineRun *run, const Scene *launched, Error *error);
bool engine_run_step(EngineRun *run, Error *error);
void engine_run_end(EngineRun *run);

/* Steps until the bomb first touches a movable box. ERROR_INPUT if it never does. */
bool engine_run_to_touch(EngineRun *run, Error *error);

/* The box of a body as collision detection used it in the last step. */
Box engine_run_box(const EngineRun *run, int body);

/* The first contact of the pair that follows the one with first contact `first`; -1 for the first pair. The number of
   contacts after the last pair. */
int next_pair(const ContactProblem *problem, int first);
