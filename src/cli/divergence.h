/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The result of twinbox diverge, and its two forms. */
#pragma once
#include "study/chaos.h"
#include "trajectory/growth.h"
#include "trajectory/trajectory_part.h"

typedef struct Divergence {
    const char *const *paths; /* [2] */
    double tolerance;         /* m */
    Trajectory *runs[2];
    TrajectoryParting parting;
    double *distance; /* [frames of both] */
    Growth growth, shifted;
    Chaos chaos; /* distance NULL: no scene given */
} Divergence;

void diverge_print(const Divergence *divergence);
bool diverge_print_json(const Divergence *divergence, Error *error);
