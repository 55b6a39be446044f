/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Recorded launches as numbers and as components (subspace/subspace_net.h). Holden et al. 2019, section 4.1. */
#pragma once
#include "learning/launch_runs.h"
#include "simulate/subspace_method.h"

/* States of launches from one step before the bomb appears on: that first state is where the bodies come from, by their
   velocities. */
typedef struct PoseRows {
    int launches, states, numbers; /* states of each launch; numbers: 4 bodies */
    float *rows;                   /* [launches, states, numbers] */
    float *launch;                 /* [launches, SUBSPACE_LAUNCH] */
} PoseRows;

bool pose_rows_make(PoseRows *rows, const Scene *scene, const LaunchRuns *runs, Error *error);
void pose_rows_free(PoseRows *rows);

static inline const float *pose_row(const PoseRows *rows, int launch, int state) {
    return rows->rows + ((size_t)launch * (size_t)rows->states + (size_t)state) * (size_t)rows->numbers;
}

/* Fills rest and basis of a net. poses[bodies of the scene]: where they rest without a bomb; the rest of the bomb is the
   mean of its rows. */
bool pose_components_fit(const PoseRows *rows, const Scene *scene, const BodyPose *poses, SubspaceNet *net,
                         Error *error);

/* components[launches, states, components of the net] of all rows; fills low and high. */
void pose_components_project(const PoseRows *rows, SubspaceNet *net, float *components);
