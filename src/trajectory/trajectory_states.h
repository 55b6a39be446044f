/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Comparison of one body in one frame of two trajectories. */
#pragma once
#include "trajectory/trajectory.h"

/* True if the velocities of both are known; else only poses are compared. */
bool trajectory_both_move(const Trajectory *a, const Trajectory *b);

/* Equal bit by bit. 0 and -0 differ: the runs have computed differently. A body that exists in neither is equal. */
bool trajectory_same_state(const Trajectory *a, const Trajectory *b, int frame, int body);

/* Zeros unless the body exists in both; speed and spin are 0 if the velocities of one are unknown. */
typedef struct StateDifference {
    bool in_a, in_b;
    double distance; /* m, between the two positions */
    double angle;    /* rad */
    double speed;    /* m/s, between the two velocities */
    double spin;     /* rad/s */
} StateDifference;

StateDifference trajectory_state_difference(const Trajectory *a, const Trajectory *b, int frame, int body);

/* True, with a description, if the worlds differ: number, sizes or kinds of bodies, or dt. */
bool trajectory_different_worlds(const Trajectory *a, const Trajectory *b, char *what, size_t size);
