/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The separating axis theorem, computed for display: two boxes overlap if their projections on all four axes do, and
   the axis of the least overlap is the contact normal. collision/manifold.c has the optimised version. */
#pragma once
#include "collision/manifold.h"

/* The projections of boxes a and b on an axis. */
typedef struct AxisOverlap {
    int box;                /* owner of the axis: 0 is a, 1 is b */
    char letter;            /* 'x' or 'y', the axis in its box */
    Vec2 axis;              /* unit */
    double low[2], high[2]; /* m from the world's origin: the projections of a and of b */
    double depth;           /* m that b must move to separate; negative if separated */
} AxisOverlap;

enum { SEPARATING_AXES = 4 };

/* The axes of a, x first, then those of b. */
void separating_axes(AxisOverlap overlaps[SEPARATING_AXES], const Box *a, const Box *b);

/* The index of the least depth. */
int least_overlap(const AxisOverlap overlaps[SEPARATING_AXES]);
