/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contacts of some stored frames of a run, rounded; page/codec.js is the decoder. Those of a frame are of the step that
   follows from its poses; of the last frame, of its own step.

   A number per frame: of contacts. Then columns with a number per contact: bodies a and b, feature; and, as differences
   from the same contact in the frame before, the point's x and y from the centre of b in units of `length`, the normal's x
   and y in 1/256, the logarithm of the normal impulse, and the tangent impulse in 1/64 of the normal one and a unit. In a
   pile that rests, friction keeps its share of the normal impulse: so most differences are small. */
#pragma once
#include "player/bytes.h"
#include "player/player_frames.h"

/* What is rounded away. */
typedef struct ContactUnits {
    float length;  /* m, of points */
    float impulse; /* N s: normal ones below it are rounded to 1/32 of it, larger ones to 1.6% */
} ContactUnits;

/* Stored frames [begin, end) of a run. */
bool contact_chunk(Bytes *chunk, const Trajectory *run, const PlayerFrames *frames, int begin, int end,
                   const ContactUnits *units, Error *error);
