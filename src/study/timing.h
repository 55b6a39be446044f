/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Measures the cost of contenders, in turns on one core, with repetitions. */
#pragma once
#include "common/progress.h"
#include "study/contenders.h"
#include "study/frozen.h"

/* Microseconds per step in one phase: means over the steps of the median and the quartiles that each step has over the
   repetitions. NaN if the phase does not occur. */
typedef struct StepCost {
    double solver, solver_q1, solver_q3; /* of the solver alone: median, quartiles */
    double step;                         /* of the whole step: median */
    int steps;                           /* of the phase, in each repetition */
    double instructions;                 /* of the solver; NaN if they cannot be counted */
} StepCost;

typedef struct TimingOptions {
    const Scene *launches;         /* [launch_count] launched scenes, run in closed loop */
    int launch_count, repetitions; /* each repetition runs all launches */
    int last_frame;                /* of each run */
    bool no_instructions;          /* do not count them: that takes a run more */
} TimingOptions;

/* Fills closed[count][PHASES] (closed loop) and frozen[count][PHASES] (frozen steps). */
bool timing_measure(const Contender *const *contenders, int count, const TimingOptions *options,
                    const SnapshotList *snapshots, StepCost (*closed)[PHASES], StepCost (*frozen)[PHASES],
                    const Progress *progress, Error *error);

/* Mean over the steps of all phases: of the whole step, or only of the solver, for methods whose step is nothing else
   (no_contacts in common/method_description.h). NaN without steps. */
double step_cost_mean(const StepCost costs[PHASES], bool only_solver);
