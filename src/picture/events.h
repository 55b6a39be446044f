/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The key frames of a comparison: impact and first divergence. */
#pragma once
#include "trajectory/trajectory.h"

/* m; smaller distances are invisible in a picture */
#define EVENTS_VISIBLE_DISTANCE 1e-3

typedef struct Events {
    int impact;     /* trajectory_impact() of the first run that has one; -1: none */
    int divergence; /* first frame where a body is more than this from the first run's; -1: none */
    int run, body;  /* the run and the body that diverge first */
} Events;

/* Runs whose world differs from the first run's are not compared. */
Events events_find(const Trajectory *const *runs, int count);
