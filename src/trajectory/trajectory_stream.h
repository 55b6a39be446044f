/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Writes a run while it is made, in bounded memory. A part of a run is a Trajectory whose frame 0 is the frame after the
   last one of the part before, with the contacts of the steps that end in its frames. The files are those that
   trajectory_write(), trajectory_write_csv() and trajectory_write_hashes() write of the whole. */
#pragma once
#include "trajectory/trajectory.h"

typedef struct TrajectoryStream TrajectoryStream;

typedef enum TrajectoryFormat { TRAJECTORY_NPZ, TRAJECTORY_CSV, TRAJECTORY_HASHES } TrajectoryFormat;

/* A stream for a run of `frames` frames; names, sizes and all else that does not change are those of `head`, which may
   be its first part. NULL with error set if no file can be written at `path`. */
TrajectoryStream *trajectory_stream_create(const Trajectory *head, int frames, TrajectoryFormat format,
                                           const char *path, Error *error);
bool trajectory_stream_add(TrajectoryStream *stream, const Trajectory *part, Error *error);

/* Sets the verdict on the run, which is known when all frames have been added (trajectory_judge). Only .npz has it. */
void trajectory_stream_judge(TrajectoryStream *stream, const char *words, int frame, int body);

/* Writes the file, atomically, when all frames have been added. */
bool trajectory_stream_finish(TrajectoryStream *stream, Error *error);

/* Discards what trajectory_stream_finish() has not written. */
void trajectory_stream_destroy(TrajectoryStream *stream);
