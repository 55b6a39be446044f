/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The part of the world that bodies of a run cover. */
#pragma once
#include "trajectory/trajectory.h"

/* m; bodies that reach farther do not count, or nothing else could be made out. */
#define EXTENT_FARTHEST 1e5

typedef struct Extent {
    double left, right, bottom, top; /* m */
} Extent;

extern const Extent extent_empty;

bool extent_is_empty(const Extent *extent);

/* Widens the extent by a body's bounding box in this frame, unless it has no pose there or reaches too far. */
void extent_include(Extent *extent, const Trajectory *run, int frame, int body);
