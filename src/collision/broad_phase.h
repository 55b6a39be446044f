/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Broad phase: which pairs of boxes may touch. */
#pragma once
#include "collision/manifold.h"

#include <stdbool.h>
#include <stddef.h>

/* Axis-aligned bounds, m. */
typedef struct Bounds {
    Vec2 low, high;
} Bounds;

/* The bounds of a box, widened by what float32 may have rounded off: two boxes whose bounds are apart would not
   touch in the narrow phase either. */
Bounds bounds_of_box(const Box *box);

static inline bool bounds_overlap(const Bounds *a, const Bounds *b) {
    return a->low.x <= b->high.x && b->low.x <= a->high.x && a->low.y <= b->high.y && b->low.y <= a->high.y;
}

typedef struct BodyPair {
    int a, b; /* a < b */
} BodyPair;

/* Pairs that persist in memory from step to step. Zero-initialise; free pairs with free(). */
typedef struct PairList {
    BodyPair *pairs;
    size_t count, capacity;
} PairList;

/* Fills the list with all pairs of overlapping bounds, not both fixed, rising by (a, b): the order in which
   sequential impulses visits them. False when memory is short. */
bool broad_phase_find(PairList *list, const Bounds *bounds, const bool *fixed, int count);
