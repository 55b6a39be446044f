/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Records a run: into a trajectory in memory, or into files while the run is made, in bounded memory. Files are written
   by a second thread. */
#pragma once
#include "simulate/simulate.h"
#include "trajectory/trajectory_stream.h"

/* The limit of bodies times frames of a trajectory: 24 bytes each, 1.2 GB. */
enum { SIMULATE_MAX_STATES = 50000000, RECORDER_OUTPUTS_MAX = 2 };

typedef struct RecorderOutput {
    const char *path;
    TrajectoryFormat format;
} RecorderOutput;

/* Records all frames in memory. Scene and method must last as long as the recorder. NULL with error set if the run is
   too long or memory is short. */
Recorder *recorder_create(const Scene *scene, const Method *method, Error *error);

/* Records to files (none is allowed). no_contacts leaves them out. NULL with error set also if a file cannot be
   written. */
Recorder *recorder_create_to(const Scene *scene, const Method *method, const RecorderOutput *outputs, int count,
                             bool no_contacts, Error *error);

/* Discards the files that recorder_finish() has not written. */
void recorder_destroy(Recorder *recorder);

/* Records a frame; 0: before the first step. Frames in rising order, without gaps. RunWatch does it. */
bool recorder_record(Recorder *recorder, int frame, const World *world, Error *error);

/* After the run, before recorder_finish() or recorder_take(): the verdict on it (trajectory_judge). */
void recorder_judge(Recorder *recorder, const char *words, int frame, int body);

/* After the run: the files are written. */
bool recorder_finish(Recorder *recorder, Error *error);

/* After the run: the trajectory of a recorder in memory, which the caller destroys. */
Trajectory *recorder_take(Recorder *recorder);

/* Bodies of the run, and after it the hash of its last frame (trajectory_frame_hash). */
int recorder_bodies(const Recorder *recorder);
uint64_t recorder_state_hash(const Recorder *recorder);
