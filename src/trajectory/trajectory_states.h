/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One body in one frame of two trajectories, side by side: what comparing them is made of. */
#pragma once
#include "trajectory/trajectory.h"

/* m. Not hypot: square roots are the same on every machine, and squares of floats do not overflow a double. */
double point_distance(Vec2 a, Vec2 b);

/* Equal bit by bit: 0 and -0 differ, as a run that shows one where another shows the other has taken another way. A body
   that is in neither is equal. */
bool trajectory_same_state(const Trajectory *a, const Trajectory *b, int frame, int body);

/* Zeros where the body is not in both. */
typedef struct StateDifference {
    bool in_a, in_b;
    double distance; /* m, between the two positions */
    double angle;    /* rad */
    double speed;    /* m/s, between the two velocities */
    double spin;     /* rad/s */
} StateDifference;

StateDifference trajectory_state_difference(const Trajectory *a, const Trajectory *b, int frame, int body);

/* True, and what it is in words, where something makes the frames incomparable: number, sizes or kinds of the bodies, or
   dt. */
bool trajectory_different_worlds(const Trajectory *a, const Trajectory *b, char *what, size_t size);
