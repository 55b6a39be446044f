/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Learned momentum: a schedule has one factor per sweep, and there is one schedule for each number of sweeps that was
   fitted. Training writes them, solvers/learned_momentum.c reads them. */
#pragma once
#include "common/error.h"

enum { MOMENTUM_VERSION = 1, MOMENTUM_MAX_SCHEDULES = 16, MOMENTUM_MAX_SWEEPS = 1000, MOMENTUM_TEXT_SIZE = 512 };

#define MOMENTUM_MAX_FACTOR 2.0f /* a larger factor would extrapolate by more than the change of two sweeps */

typedef struct MomentumSchedules {
    int count;
    int sweeps[MOMENTUM_MAX_SCHEDULES];     /* rising */
    float *factors[MOMENTUM_MAX_SCHEDULES]; /* [sweeps], 0 to MOMENTUM_MAX_FACTOR; the first has no effect */
    char command[MOMENTUM_TEXT_SIZE];       /* the command that made them */
} MomentumSchedules;

void momentum_schedules_free(MomentumSchedules *schedules);

/* The schedule for that many sweeps, or NULL. */
const float *momentum_schedules_find(const MomentumSchedules *schedules, int sweeps);

/* Appends a schedule of a larger number of sweeps than the last; factors are copied. False when memory is short. */
bool momentum_schedules_add(MomentumSchedules *schedules, int sweeps, const float *factors, Error *error);

/* .npz: version, kind ("momentum-schedules"), command, sweeps[count], factors[sum of sweeps], one after the other. */
bool momentum_schedules_write(const MomentumSchedules *schedules, const char *path, Error *error);

/* ERROR_INPUT, naming the file, if it is damaged, of another version, or has factors out of bounds. */
bool momentum_schedules_read(MomentumSchedules *schedules, const char *path, Error *error);
