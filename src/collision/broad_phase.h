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
   sequential impulses visits them. Looks at every pair: the text to read, and the fast way for few bodies. False when
   memory is short. */
bool broad_phase_find(PairList *list, const Bounds *bounds, const bool *fixed, int count);

typedef struct SweptBounds SweptBounds;

/* The same pairs in the same order by sort and sweep (Baraff 1992): bounds sorted by where they begin along an axis
   need looking at only until one begins behind the end. The order persists and changes little from step to step. Across
   the axis the plane is cut into strips, each swept by itself, so that a wide world costs no more a body than a small
   one. Zero-initialise. */
typedef struct SortAndSweep {
    bool along_y;
    int count, strip_count;
    float strips_begin, strips_per_metre;
    SweptBounds *sorted;   /* [count] along the axis */
    SweptBounds *in_strip; /* strip by strip, in the same order; a body may be in several */
    int *starts;           /* scratch: of strips in in_strip, then of bodies in the list of pairs */
    PairList found;        /* strip by strip */
    size_t sorted_capacity, in_strip_capacity, starts_capacity;
} SortAndSweep;

void sort_and_sweep_free(SortAndSweep *sweep);
bool sort_and_sweep_find(SortAndSweep *sweep, PairList *list, const Bounds *bounds, const bool *fixed, int count);
