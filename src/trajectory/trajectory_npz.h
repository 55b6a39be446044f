/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A trajectory as .npz, part by part. Only trajectory_stream.c includes this. */
#pragma once
#include "trajectory/trajectory.h"

typedef struct TrajectoryNpz TrajectoryNpz;

TrajectoryNpz *trajectory_npz_create(const Trajectory *head, const char *path, Error *error);
bool trajectory_npz_add(TrajectoryNpz *npz, const Trajectory *part, Error *error);

/* Instead of the head's verdict. */
void trajectory_npz_judge(TrajectoryNpz *npz, const char *words, int frame, int body);

bool trajectory_npz_finish(TrajectoryNpz *npz, Error *error);
void trajectory_npz_destroy(TrajectoryNpz *npz);
