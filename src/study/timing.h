/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the contenders cost: in turns on one core, many times over. */
#pragma once
#include "common/progress.h"
#include "study/contenders.h"
#include "study/frozen.h"

/* Microseconds a step of one phase, over the repetitions; NAN where the phase never came. */
typedef struct StepCost {
    double solver, solver_q1, solver_q3; /* median and quartiles of what the method needs beyond the contact problem */
    double step;                         /* median of the whole step */
    double instructions;                 /* of the solver; NAN where they cannot be counted */
} StepCost;

typedef struct TimingOptions {
    const Scene *launches;         /* [launch_count] launched scenes, run in closed loop */
    int launch_count, repetitions; /* each repetition runs them all */
    int last_frame;                /* of each run */
} TimingOptions;

/* Costs in closed loop into closed[count][PHASES], and over the frozen steps into frozen[count][PHASES]. */
bool timing_measure(const Contender *const *contenders, int count, const TimingOptions *options,
                    const SnapshotList *snapshots, StepCost (*closed)[PHASES], StepCost (*frozen)[PHASES],
                    const Progress *progress, Error *error);
