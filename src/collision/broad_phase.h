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

/* The bounds of a box, widened by the float32 rounding error: boxes whose bounds are disjoint do not touch in the
   narrow phase either. */
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

/* Fills the list with all pairs of overlapping bounds, not both fixed, sorted by (a, b): the order in which sequential
   impulses visits them. Tests every pair: the reference implementation, and the fastest for few bodies. False when
   memory is short. */
bool broad_phase_find(PairList *list, const Bounds *bounds, const bool *fixed, int count);

/* A hundred for each of 10,000 boxes. Boxes that lie on one another have a pair for every two: 10,000 would need 16 GB. */
enum { BROAD_PHASE_MAX_PAIRS = 1 << 20 };

typedef struct SweptBounds SweptBounds;

/* The same pairs in the same order by sort and sweep (Baraff 1992): bounds are sorted by their lower end along an axis,
   and each is tested only against those that begin before it ends. The order persists and changes little from step to
   step. Across the axis the plane is cut into strips that are swept separately, so that the cost per body does not grow
   with the width of the world. Zero-initialise. sort_and_sweep_find() is also false for more than
   BROAD_PHASE_MAX_PAIRS, and then sets too_many. */
typedef struct SortAndSweep {
    bool along_y, too_many;
    int count, strip_count;
    float strips_begin, strips_per_metre;
    SweptBounds *sorted;   /* [count] along the axis */
    SweptBounds *in_strip; /* strip by strip, in the same order; a body may be in several */
    int *starts;           /* scratch: first index of each strip in in_strip, then of each body in the list of pairs */
    PairList found;        /* strip by strip */
    size_t sorted_capacity, in_strip_capacity, starts_capacity;
} SortAndSweep;

void sort_and_sweep_free(SortAndSweep *sweep);
bool sort_and_sweep_find(SortAndSweep *sweep, PairList *list, const Bounds *bounds, const bool *fixed, int count);
