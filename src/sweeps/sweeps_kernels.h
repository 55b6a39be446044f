/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Internal functions of sweeps.c and sweeps_load.c. */
#pragma once
#include "sweeps/sweeps.h"

enum { SWEEPS_AT_ONCE = 16 }; /* sweeps in one schedule, which is run repeatedly */

/* Makes the schedule of that many sweeps over the pairs; turns: with momentum extrapolation. False when memory is
   short. */
bool sweeps_schedule(SweepSchedule *schedule, Sweeps *sweeps, int count, bool turns);

bool sweeps_have_avx2(void);

/* Solves the levels one after the other, eight pairs at a time. factors: one for each of the schedule's sweeps, or NULL
   without momentum extrapolation. */
void sweeps_run_avx2(Sweeps *sweeps, const SweepSchedule *schedule, const float *factors);

/* The same with the normal impulses of a pair solved together. */
void sweeps_run_blocks_avx2(Sweeps *sweeps, const SweepSchedule *schedule);

/* Applies the initial impulses in the sums. */
void sweeps_warm_start(Sweeps *sweeps);

/* Sweeps pair by pair, and stops early after a sweep without a change: later ones would change nothing. */
void sweeps_run_one_by_one(Sweeps *sweeps, const float *factors, int count);
