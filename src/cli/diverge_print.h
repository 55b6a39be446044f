/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Prints the result of twinbox diverge. */
#pragma once
#include "study/chaos.h"
#include "trajectory/growth.h"
#include "trajectory/trajectory_part.h"

void diverge_print_runs(const char *const paths[2], const Trajectory *a, const Trajectory *b);

/* The first difference, its cause, and the first one beyond the tolerance. `a` tells the bomb's index and dt. */
void diverge_print_parting(const Trajectory *a, const TrajectoryParting *parting, double tolerance);

void diverge_print_growth(const Growth *growth, double dt);
void diverge_print_chaos(const Chaos *chaos, const Growth *growth, const Growth *shifted, double dt);
