/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the stepper gns (gns.c) knows besides the world. */
#pragma once
#include "simulate/stepping.h"

/* m: after a step, how far the particles of stepping_gns's state are from the best-fitting rigid boxes: the root of the mean
   square over the particles of a box, mean over boxes; 0 with rigid=on, but for rounding, and without boxes. */
float gns_shape_distance(const void *state);
