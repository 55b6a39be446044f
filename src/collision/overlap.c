/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "collision/overlap.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

static double dot(Vec2 a, Vec2 b) { return (double)a.x * (double)b.x + (double)a.y * (double)b.y; }

/* Half the extent of a box along an axis, m. */
static double reach(const Box *box, Vec2 axis) {
    return fabs(dot(box->rotation.column1, axis)) * (double)box->half.x +
           fabs(dot(box->rotation.column2, axis)) * (double)box->half.y;
}

/* The overlap along one axis. */
static double along(const Box *a, const Box *b, Vec2 axis) {
    return reach(a, axis) + reach(b, axis) - fabs(dot(b->position, axis) - dot(a->position, axis));
}

double overlap_depth(const Box *a, const Box *b) {
    return fmin(fmin(along(a, b, a->rotation.column1), along(a, b, a->rotation.column2)),
                fmin(along(a, b, b->rotation.column1), along(a, b, b->rotation.column2)));
}

static double largest(const Box *box) {
    return fmax(fabs((double)box->position.x), fabs((double)box->position.y)) +
           fmax((double)box->half.x, (double)box->half.y);
}

/* Positions are sums of a first one and a spacing: two roundings for each box. */
static double rounding(const Box *a, const Box *b) { return 2 * (double)FLT_EPSILON * (largest(a) + largest(b)); }

bool overlap_exceeds(const Box *a, const Box *b, double depth) {
    const double limit = depth + rounding(a, b);
    return along(a, b, a->rotation.column1) > limit && along(a, b, a->rotation.column2) > limit &&
           along(a, b, b->rotation.column1) > limit && along(a, b, b->rotation.column2) > limit;
}

/* Cuts the span to the x at which the projections on the axis overlap by more than the limit. */
static void cut(OverlapSpan *span, const Box *a, const Box *b, Vec2 axis, double both, double limit) {
    const double least = 1e-9, room = both - limit;
    const double across = ((double)b->position.y - (double)a->position.y) * (double)axis.y;
    if (room <= 0 || (fabs((double)axis.x) < least && fabs(across) >= room)) *span = (OverlapSpan){0, 0};
    if (fabs((double)axis.x) < least) return;
    const double first = (double)a->position.x + (-room - across) / (double)axis.x;
    const double second = (double)a->position.x + (room - across) / (double)axis.x;
    span->from = fmax(span->from, fmin(first, second));
    span->to = fmin(span->to, fmax(first, second));
}

OverlapSpan overlap_span(const Box *a, const Box *b, double depth, bool any_rotation) {
    const Vec2 axes[] = {a->rotation.column1, a->rotation.column2, b->rotation.column1, b->rotation.column2};
    const double radius = vec2_distance(b->half, vec2(0, 0)), limit = depth + rounding(a, b);
    OverlapSpan span = {-INFINITY, INFINITY};
    for (int i = 0; i < (any_rotation ? 2 : 4); i++)
        cut(&span, a, b, axes[i], reach(a, axes[i]) + (any_rotation ? radius : reach(b, axes[i])), limit);
    return span;
}

/* Bounds of a box along the axis of the sweep. */
typedef struct Entry {
    float low, high;
    int body;
} Entry;

static int by_low(const void *a, const void *b) {
    const Entry *left = a, *right = b;
    if (left->low != right->low) return left->low < right->low ? -1 : 1;
    return left->body - right->body;
}

/* The axis along which the boxes are further apart. */
static bool spread_along_y(const Box *boxes, int count) {
    Vec2 low = boxes[0].position, high = low;
    for (int i = 1; i < count; i++) {
        low = vec2(fminf(low.x, boxes[i].position.x), fminf(low.y, boxes[i].position.y));
        high = vec2(fmaxf(high.x, boxes[i].position.x), fmaxf(high.y, boxes[i].position.y));
    }
    return high.y - low.y > high.x - low.x;
}

static BodyPair sweep(const Entry *entries, const Box *boxes, const bool *fixed, int count, double depth) {
    for (int i = 0; i < count; i++)
        for (int k = i + 1; k < count && entries[k].low <= entries[i].high; k++) {
            const int a = entries[i].body, b = entries[k].body;
            if ((fixed[a] && fixed[b]) || !overlap_exceeds(&boxes[a], &boxes[b], depth)) continue;
            return (BodyPair){a < b ? a : b, a < b ? b : a};
        }
    return (BodyPair){-1, -1};
}

bool overlap_find(const Box *boxes, const bool *fixed, int count, double depth, BodyPair *found) {
    *found = (BodyPair){-1, -1};
    if (count == 0) return true;
    Entry *entries = malloc((size_t)count * sizeof *entries);
    if (entries == NULL) return false;
    const bool along_y = spread_along_y(boxes, count);
    for (int i = 0; i < count; i++) {
        const Bounds bounds = bounds_of_box(&boxes[i]);
        entries[i] = (Entry){along_y ? bounds.low.y : bounds.low.x, along_y ? bounds.high.y : bounds.high.x, i};
    }
    qsort(entries, (size_t)count, sizeof *entries, by_low);
    *found = sweep(entries, boxes, fixed, count, depth);
    free(entries);
    return true;
}
