/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The moments of a comparison that a viewer asks for. */
#pragma once
#include "trajectory/trajectory.h"

/* m: what is less cannot be seen in a picture. */
#define EVENTS_APART 1e-3

typedef struct Events {
    int impact; /* trajectory_impact() of the first run that has one; -1: none */
    int apart; /* first frame in which a body of another run is more than EVENTS_APART from the first run's; -1: none */
    int run, body; /* whose */
} Events;

/* Runs of other worlds than the first are never apart from it. */
Events events_find(const Trajectory *const *runs, int count);
