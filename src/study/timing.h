/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Costs of the contenders, measured in turns on one core, with repetitions. */
#pragma once
#include "common/progress.h"
#include "study/contenders.h"
#include "study/frozen.h"

/* Cost of a step of one phase, microseconds; NAN if the phase never occurred. */
typedef struct StepCost {
    double solver, solver_q1,
        solver_q3;       /* median and quartiles over the repetitions, without making the contact problem */
    double step;         /* median of the whole step */
    double instructions; /* of the solver; NAN if they cannot be counted */
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
