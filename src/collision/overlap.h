/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How deep boxes overlap, by separating axes in double. For what a scene places, not for contacts: manifold.h prefers
   the face of the last step to the axis of the smallest overlap. */
#pragma once
#include "collision/broad_phase.h"

/* The smallest overlap of two boxes along the axes of their faces, m; negative: they are apart by that much along one.
   */
double overlap_depth(const Box *a, const Box *b);

/* True if they overlap by more than `depth` m and the float32 rounding of their positions. */
bool overlap_exceeds(const Box *a, const Box *b, double depth);

typedef struct OverlapSpan {
    double from, to; /* m */
} OverlapSpan;

/* The x of b's centre at which it would overlap a by more than `depth`. Empty (from >= to) if it never would. With
   any_rotation, b may be turned: the span contains those of all its rotations. */
OverlapSpan overlap_span(const Box *a, const Box *b, double depth, bool any_rotation);

/* Finds two boxes, not both fixed, that overlap by more than `depth`; found->a is -1 if no two do. Stops at the
   first pair, so that memory is linear in `count` for any boxes. False when memory is short. */
bool overlap_find(const Box *boxes, const bool *fixed, int count, double depth, BodyPair *found);
