/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The cost of contenders, measured in turns on one core, with repetitions: on two cores at once, one method or another
   takes a third longer. The first steps of each, those of one launch, do not count.

   A time varies if the distance of its quartiles, as a share of its median, is more than TIMES_VARY_FACTOR that of
   the middle one of the other contenders in the same protocol and phase, more than TIMES_VARY_LEAST, and more than a
   clock's own error, TIMES_VARY_US. Its launches that vary so are measured again, and have the
   times of the second measurement only; so are its frozen steps. */
#pragma once
#include "base/base.h"
#include "base/machine.h"
#include "scenes/scenes.h"
#include "studies/contenders.h"
#include "studies/rollout.h"

#include <stdbool.h>

#define TIMES_VARY_FACTOR 3.0
#define TIMES_VARY_LEAST 0.1
#define TIMES_VARY_US 0.1

/* Microseconds per step in one phase: means over the steps of the median and the quartiles that each step has over the
   repetitions. NaN if the phase does not occur. */
typedef struct StepCost {
    double solver, solver_q1, solver_q3; /* of the solver alone: median, quartiles */
    double step;                         /* of the whole step: median */
    double engine;                       /* of an external method, instead of all others: median; else NaN */
    int steps;                           /* of the phase, in each repetition */
    bool varies;                         /* also when it was measured again */
} StepCost;

typedef struct TimingOptions {
    const Scene *launches;         /* [launch_count] launched scenes, run in closed loop */
    int launch_count, repetitions; /* each repetition runs all launches */
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
