/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The states of some stored frames of a run, without loss; page/codec.js is the decoder.

   For vx, vy, omega, x, y, angle in turn: each body's values in the order of frames, as the difference of the float's bits
   from those of a prediction. That of a velocity is its value in the frame before. That of a pose is the one that a step
   with the new velocity leads to, x + dt * vx in float: this is how the engine moves bodies, so most differences are 0. In
   the first frame of a chunk the prediction is 0, so that each chunk can be decoded by itself. */
#pragma once
#include "player/bytes.h"
#include "player/player_frames.h"

/* Stored frames [begin, end) of a run. */
bool state_chunk(Bytes *chunk, const Trajectory *run, const PlayerFrames *frames, int begin, int end, Error *error);
