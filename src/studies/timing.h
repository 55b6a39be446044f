/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cost of contenders. The time of a step is the least of its repetitions, as what interrupts a step only adds to
   its time. Contenders take turns launch by launch, so that a slow second of the machine affects all of them. They run
   on one core: on two at once, one method or another takes a third longer. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "scenes/scenes.h"
#include "studies/contenders.h"
#include "studies/rollout.h"

#include <stdbool.h>

/* Microseconds per step in one phase, means over the steps. NaN if the phase does not occur. */
typedef struct StepCost {
    double solver; /* of the solver alone */
    double step;   /* of the whole step */
    double engine; /* of an external method, instead of both: what it reports; else NaN */
    int steps;     /* of the phase, in each repetition */
} StepCost;

typedef struct TimingOptions {
    const Scene *launches;         /* [launch_count] launched scenes, run in closed loop */
    int launch_count, repetitions; /* each repetition runs all launches; in the first, caches fill */
    int last_frame;                /* of each run, which ends with the phase after the impact */
    int shared_steps;              /* of all launches: measured once (contender_shares()) */
    Stepper *const *steppers;      /* [contenders] the caller's; NULL: they are made, and destroyed */
} TimingOptions;

/* Fills closed[count][PHASES] (closed loop) and frozen[count][PHASES] (frozen steps). */
bool timing_measure(const Contender *const *contenders, int count, const TimingOptions *options,
                    const SnapshotList *snapshots, StepCost (*closed)[PHASES], StepCost (*frozen)[PHASES],
                    const Progress *progress, Error *error);

/* Fills closed[count][PHASES] of one launch. count: at most TIMING_OF_LAUNCH. */
enum { TIMING_OF_LAUNCH = 2 };
bool timing_of_launch(const Contender *const *contenders, int count, const Scene *launched, int last_frame,
                      int repetitions, StepCost (*closed)[PHASES], Error *error);

/* Mean over the steps of all phases: of the whole step, or only of the solver, for methods whose step is nothing else
   (no_contacts in methods/methods.h). NaN without steps. */
double step_cost_mean(const StepCost costs[PHASES], bool only_solver);
