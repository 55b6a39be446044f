/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The separating axis theorem, written out to be shown: two boxes overlap where their shadows on all four axes do, and
   the axis of the least overlap tells which way they touch. collision/manifold.c has it in the fewest operations. */
#pragma once
#include "collision/manifold.h"

/* What two boxes a and b are along one axis. */
typedef struct AxisOverlap {
    int box;                /* whose axis: 0 is a, 1 is b */
    char letter;            /* 'x' or 'y' of that box */
    Vec2 axis;              /* unit */
    double low[2], high[2]; /* m, from the world's origin: the shadows of a and of b */
    double depth;           /* m that b would have to go for them to part; negative where they are apart */
} AxisOverlap;

enum { SEPARATING_AXES = 4 };

/* The axes of a, x first, then those of b. */
void separating_axes(AxisOverlap overlaps[SEPARATING_AXES], const Box *a, const Box *b);

/* The axis of the least depth. */
int least_overlap(const AxisOverlap overlaps[SEPARATING_AXES]);
