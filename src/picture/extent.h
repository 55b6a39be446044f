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

/* The larger side. */
double extent_side(const Extent *extent);

/* Wider by this on each side. */
Extent extent_widened(const Extent *extent, double by);

/* Widens the extent by a body's bounding box in this frame, unless it has no pose there or reaches too far. */
void extent_include(Extent *extent, const Trajectory *run, int frame, int body);

/* Widens it down to the first static body straight below the body's centre, if there is one. */
void extent_include_ground(Extent *extent, const Trajectory *run, int frame, int body);

/* Whether the body's centre is inside; false for a body without a pose. */
bool extent_holds(const Extent *extent, const Trajectory *run, int frame, int body);
