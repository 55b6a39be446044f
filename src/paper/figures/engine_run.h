/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A run by the engine that figures look into, step by step. */
#pragma once
#include "collision/manifold.h"
#include "simulate/phases.h"
#include "simulate/simulate.h"

typedef struct EngineRun {
    const Scene *scene; /* with the launch; the caller's */
    World *world;
    Stepper *stepper;
    int frame; /* number of the last step; 0: none yet */
    PhaseTracker tracker;
} EngineRun;

/* On failure nothing is to be ended. */
bool engine_run_begin(EngineRun *run, const Scene *launched, Error *error);
bool engine_run_step(EngineRun *run, Error *error);
void engine_run_end(EngineRun *run);

/* Steps until the bomb first touches a box that can move. ERROR_INPUT where it never does. */
bool engine_run_to_touch(EngineRun *run, Error *error);

/* The box that collision saw in the last step. */
Box engine_run_box(const EngineRun *run, int body);

/* The first contact of the pair after the one whose contacts begin at `first`, -1: of the first pair; the number of
   contacts where there is none. */
int next_pair(const ContactProblem *problem, int first);
