/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The frames of the runs that a page has: stored frame i is frame first + i * every. */
#pragma once
#include "trajectory/trajectory.h"

enum { PLAYER_CHUNK = 128 }; /* stored frames that are decoded together */

typedef struct PlayerFrames {
    int first, last, every; /* frames of the runs; last: of the longest */
} PlayerFrames;

static inline int player_frame(const PlayerFrames *frames, int stored) {
    return frames->first + stored * frames->every;
}

/* The number of stored frames of a run with this many frames. */
static inline int player_frame_count(const PlayerFrames *frames, int run_frames) {
    const int last = frames->last < run_frames - 1 ? frames->last : run_frames - 1;
    return last < frames->first ? 0 : (last - frames->first) / frames->every + 1;
}

/* The first stored frame that is not before a frame of the run; -1 for a frame (-1) that is not there, or not stored. */
static inline int player_stored(const PlayerFrames *frames, int frame) {
    if (frame < 0 || frame > frames->last) return -1;
    const int stored = frame <= frames->first ? 0 : (frame - frames->first + frames->every - 1) / frames->every;
    return player_frame(frames, stored) <= frames->last ? stored : -1;
}

/* s between stored frames. */
static inline float player_dt(const PlayerFrames *frames, const Trajectory *run) {
    return run->dt * (float)frames->every;
}
