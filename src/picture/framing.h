/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the default camera frames: what stands and what strikes it. These are the moving bodies where they start, the
   ground below them, and the bomb's way until it first touches one of them; if that way is longer sideways than up or
   down, also room on the far side, as wide as what stands is high. What happens after the impact does not count, so that
   runs with the same start have the same view: a body that flies off leaves the picture and changes nothing in the frames
   before. Only if most of the bodies go far away, as on a slope, is it all that they reach in the whole run. */
#pragma once
#include "picture/extent.h"

typedef struct Framing {
    Extent extent;
    double middle; /* m, x of the middle of what stands */
} Framing;

Framing framing_of(const Trajectory *run);

/* The moving bodies in these frames, without those that have gone far away from what stood at the start; the static bodies
   if there are none. Empty if nothing can be framed. A frame beyond the run's last counts as the last. */
Extent framing_in_frames(const Trajectory *run, const int *frames, int count);
