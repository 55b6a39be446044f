/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Boxes: where two touch, which of many may, and how deep they overlap.

       const Box a = box_make(position_a, size, angle_a), b = box_make(position_b, size, angle_b);
       Manifold manifold;
       manifold_compute(&manifold, &a, &b); // manifold.count points where they touch
*/
#pragma once
#include "engine/plane.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Narrow phase: two boxes -> the points where they touch. Separating axes, then clipping of the incident edge
   (Catto, "Fast and Simple Physics using Sequential Impulses", GDC 2006). */

/* A box for collision detection; its rotation is computed once per step, not once per pair. */
typedef struct Box {
    Vec2 position;  /* m */
    Vec2 half;      /* half width and height, m */
    Mat22 rotation; /* box to world */
} Box;

Box box_make(Vec2 position, Vec2 size, float angle);

/* Edges of a box, counter-clockwise from the top. */
typedef enum Edge { NO_EDGE, EDGE_TOP, EDGE_LEFT, EDGE_BOTTOM, EDGE_RIGHT } Edge;

typedef struct ManifoldPoint {
    Vec2 position;    /* m, world, on the reference face */
    float separation; /* m, positive where a gap is */
    uint32_t feature; /* bytes from the lowest: incoming and outgoing edge of a, then of b */
} ManifoldPoint;

typedef struct Manifold {
    int count;   /* 0..2 */
    Vec2 normal; /* unit, from a to b */
    ManifoldPoint points[2];
} Manifold;

/* Fills the manifold of a and b; count is 0 if they do not touch. */
void manifold_compute(Manifold *manifold, const Box *a, const Box *b);

/* The same for boxes that are apart by no more than `gap` m, too; so are points. last: NULL, or the normal with which
   they touched before; b stays on that side of a, even where its centre has been pressed past that of a. */
void manifold_compute_within(Manifold *manifold, const Box *a, const Box *b, float gap, const Vec2 *last);

/* The same, by the faces alone that are at 45 degrees and more to `normal`. Returns the separation of the face that it
   takes, m, also if no point lies on both boxes; it is above the gap for boxes that do not touch. */
float manifold_compute_across(Manifold *manifold, const Box *a, const Box *b, float gap, Vec2 normal);

/* Broad phase: which pairs of boxes may touch. */

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

/* A hundred for each of 10,000 boxes. Boxes that lie on one another have a pair for every two: 10,000 would need 16
   GB. */
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
    size_t moved;          /* items, by the last sort */
    size_t sorted_capacity, in_strip_capacity, starts_capacity;
} SortAndSweep;

void sort_and_sweep_free(SortAndSweep *sweep);
bool sort_and_sweep_find(SortAndSweep *sweep, PairList *list, const Bounds *bounds, const bool *fixed, int count);

/* How deep boxes overlap, by separating axes in double. For what a scene places, not for contacts: the narrow phase
   prefers the face of the last step to the axis of the smallest overlap. */

/* Half the extent of a box along a unit vector, m. */
double box_reach(const Box *box, Vec2 axis);

/* The smallest overlap of two boxes along the axes of their faces, m; negative: they are apart by that much along one.
   */
double overlap_depth(const Box *a, const Box *b);

/* True if they overlap by more than `depth` m and the float32 rounding of their positions. */
bool overlap_exceeds(const Box *a, const Box *b, double depth);

typedef struct OverlapSpan {
    double from, to; /* m */
} OverlapSpan;

/* How far b may go along a unit vector to overlap a by more than `depth`. Empty (from >= to) if it never would. With
   any_rotation, b may be turned: the span contains those of all its rotations. */
OverlapSpan overlap_span(const Box *a, const Box *b, Vec2 along, double depth, bool any_rotation);

/* Finds two boxes, not both fixed, that overlap by more than `depth`; found->a is -1 if no two do. Stops at the
   first pair, so that memory is linear in `count` for any boxes. False when memory is short. */
bool overlap_find(const Box *boxes, const bool *fixed, int count, double depth, BodyPair *found);
