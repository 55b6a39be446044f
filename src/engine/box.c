/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Two boxes: how deep they overlap, where along x they would, and the manifold where they touch. */
#include "engine/boxes.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static double dot(Vec2 a, Vec2 b) { return (double)a.x * (double)b.x + (double)a.y * (double)b.y; }

double box_reach(const Box *box, Vec2 axis) {
    return fabs(dot(box->rotation.column1, axis)) * (double)box->half.x +
           fabs(dot(box->rotation.column2, axis)) * (double)box->half.y;
}

/* The overlap along one axis. */
static double along(const Box *a, const Box *b, Vec2 axis) {
    return box_reach(a, axis) + box_reach(b, axis) - fabs(dot(b->position, axis) - dot(a->position, axis));
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

OverlapSpan overlap_span(const Box *a, const Box *b, Vec2 way, double depth, bool any_rotation) {
    const Vec2 axes[] = {a->rotation.column1, a->rotation.column2, b->rotation.column1, b->rotation.column2};
    const double limit = depth + rounding(a, b);
    /* No box reaches farther, though its rotation is rounded. */
    const double radius = vec2_distance(b->half, vec2(0, 0)) * (1 + 2 * (double)FLT_EPSILON);
    OverlapSpan span = {-INFINITY, INFINITY};
    /* Each axis cuts the span to the ways after which the projections on it overlap by more than the limit. */
    for (int i = 0; i < (any_rotation ? 2 : 4); i++) {
        const double room = box_reach(a, axes[i]) + (any_rotation ? radius : box_reach(b, axes[i])) - limit;
        const double apart = dot(b->position, axes[i]) - dot(a->position, axes[i]), speed = dot(way, axes[i]);
        const bool never_nearer = fabs(speed) < 1e-6; /* the rounding of two unit vectors */
        if (room <= 0 || (never_nearer && fabs(apart) >= room)) return (OverlapSpan){0, 0};
        if (never_nearer) continue;
        const double first = (-room - apart) / speed, second = (room - apart) / speed;
        span.from = fmax(span.from, fmin(first, second));
        span.to = fmin(span.to, fmax(first, second));
    }
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

bool overlap_find(const Box *boxes, const bool *fixed, int count, double depth, BodyPair *found) {
    *found = (BodyPair){-1, -1};
    if (count == 0) return true;
    Entry *entries = malloc((size_t)count * sizeof *entries);
    if (entries == NULL) return false;
    /* Sorted along the axis along which the boxes are further apart. */
    Vec2 low = boxes[0].position, high = low;
    for (int i = 1; i < count; i++) {
        low = vec2(fminf(low.x, boxes[i].position.x), fminf(low.y, boxes[i].position.y));
        high = vec2(fmaxf(high.x, boxes[i].position.x), fmaxf(high.y, boxes[i].position.y));
    }
    const bool along_y = high.y - low.y > high.x - low.x;
    for (int i = 0; i < count; i++) {
        const Bounds bounds = bounds_of_box(&boxes[i]);
        entries[i] = (Entry){along_y ? bounds.low.y : bounds.low.x, along_y ? bounds.high.y : bounds.high.x, i};
    }
    qsort(entries, (size_t)count, sizeof *entries, by_low);
    for (int i = 0; i < count && found->a < 0; i++)
        for (int k = i + 1; k < count && entries[k].low <= entries[i].high && found->a < 0; k++) {
            const int a = entries[i].body, b = entries[k].body;
            if (!(fixed[a] && fixed[b]) && overlap_exceeds(&boxes[a], &boxes[b], depth))
                *found = (BodyPair){a < b ? a : b, a < b ? b : a};
        }
    free(entries);
    return true;
}

/* The order of all float operations is fixed: reference trajectories are compared bit by bit. */

Box box_make(Vec2 position, Vec2 size, float angle) {
    return (Box){position, vec2_scale(0.5f, size), mat22_rotation(angle)};
}

/* A vertex during clipping, with the edges that meet in it. */
typedef struct ClipVertex {
    Vec2 position;
    uint8_t in_reference, out_reference; /* edges of the reference box that cut here */
    uint8_t in_incident, out_incident;   /* edges of the incident box */
} ClipVertex;

/* The reference face. */
typedef struct ReferenceFace {
    bool of_b;        /* the reference box is b */
    bool along_y;     /* the face's normal is the box's y axis */
    float separation; /* m along the normal, <= 0 */
    Vec2 normal;      /* unit, from a to b */
} ReferenceFace;

/* A later axis must be better than the best so far by this much, or the reference face would alternate from step to
   step. */
static bool clearly_better(float separation, float best, float half) {
    const float relative_tolerance = 0.95f, absolute_tolerance = 0.01f;
    return separation > relative_tolerance * best + absolute_tolerance * half;
}

static Vec2 toward(float distance, Vec2 axis) { return distance > 0.0f ? axis : vec2_negate(axis); }

/* The faces at 45 degrees and more to a normal; NULL: all faces. */
static inline bool allowed(const Vec2 *across, Vec2 normal) {
    return across == NULL || fabsf(vec2_dot(*across, normal)) < 0.7072f;
}

/* Where b has been pressed past the centre of a along the axis of the last normal, which is within 45 degrees of it:
   the place on the side that b had, and the separation of that face. */
static void keep_side(Vec2 *place, Vec2 *face, Mat22 to_box, Vec2 last) {
    const Vec2 side = mat22_multiply(to_box, last);
    const bool along_x = fabsf(side.x) > fabsf(side.y);
    float *at = along_x ? &place->x : &place->y;
    if (!(*at * (along_x ? side.x : side.y) < 0)) return;
    *(along_x ? &face->x : &face->y) -= 2 * fabsf(*at);
    *at = -*at;
}

/* False if an axis separates the boxes by more than the gap. */
static inline __attribute__((always_inline)) bool find_reference_face(ReferenceFace *face, const Box *a, const Box *b,
                                                                      const Vec2 *across, float gap, const Vec2 *last) {
    Mat22 to_a = mat22_transpose(a->rotation), to_b = mat22_transpose(b->rotation);
    Vec2 between = vec2_sub(b->position, a->position);
    Vec2 in_a = mat22_multiply(to_a, between), in_b = mat22_multiply(to_b, between);
    Mat22 turn = mat22_abs(mat22_product(to_a, b->rotation));

    Vec2 face_a = vec2_sub(vec2_sub(vec2_abs(in_a), a->half), mat22_multiply(turn, b->half));
    if (face_a.x > gap || face_a.y > gap) return false;
    Vec2 face_b = vec2_sub(vec2_sub(vec2_abs(in_b), mat22_multiply(mat22_transpose(turn), a->half)), b->half);
    if (face_b.x > gap || face_b.y > gap) return false;
    if (last != NULL) {
        keep_side(&in_a, &face_a, to_a, *last);
        keep_side(&in_b, &face_b, to_b, *last);
    }

    *face = (ReferenceFace){false, false, face_a.x, toward(in_a.x, a->rotation.column1)};
    if (!allowed(across, face->normal)) face->separation = -INFINITY;
    if (clearly_better(face_a.y, face->separation, a->half.y) && allowed(across, a->rotation.column2))
        *face = (ReferenceFace){false, true, face_a.y, toward(in_a.y, a->rotation.column2)};
    if (clearly_better(face_b.x, face->separation, b->half.x) && allowed(across, b->rotation.column1))
        *face = (ReferenceFace){true, false, face_b.x, toward(in_b.x, b->rotation.column1)};
    if (clearly_better(face_b.y, face->separation, b->half.y) && allowed(across, b->rotation.column2))
        *face = (ReferenceFace){true, true, face_b.y, toward(in_b.y, b->rotation.column2)};
    return true;
}

/* The end of an edge, counter-clockwise. */
static inline ClipVertex edge_end(const Box *box, Edge edge) {
    static const Vec2 corners[] = {
        [EDGE_TOP] = {-1, 1}, [EDGE_LEFT] = {-1, -1}, [EDGE_BOTTOM] = {1, -1}, [EDGE_RIGHT] = {1, 1}};
    Vec2 end = vec2(corners[edge].x * box->half.x, corners[edge].y * box->half.y);
    Edge next = edge == EDGE_RIGHT ? EDGE_TOP : edge + 1;
    Vec2 position = vec2_add(box->position, mat22_multiply(box->rotation, end));
    return (ClipVertex){position, NO_EDGE, NO_EDGE, (uint8_t)edge, (uint8_t)next};
}

/* The edge of the incident box that is most anti-parallel to the reference normal. */
static void find_incident_edge(ClipVertex edge[2], const Box *box, Vec2 reference_normal) {
    Vec2 n = vec2_negate(mat22_multiply(mat22_transpose(box->rotation), reference_normal));
    Vec2 size = vec2_abs(n);
    Edge facing;
    if (size.x > size.y)
        facing = n.x < 0.0f ? EDGE_LEFT : EDGE_RIGHT;
    else
        facing = n.y < 0.0f ? EDGE_BOTTOM : EDGE_TOP;
    edge[0] = edge_end(box, facing == EDGE_TOP ? EDGE_RIGHT : facing - 1);
    edge[1] = edge_end(box, facing);
}

/* Clips to the half-plane normal . x <= offset; `clip_edge` is the reference edge on that line. False if fewer than two
   points remain. */
static inline bool clip(ClipVertex out[2], const ClipVertex in[2], Vec2 normal, float offset, Edge clip_edge) {
    int count = 0;
    float distance0 = vec2_dot(normal, in[0].position) - offset;
    float distance1 = vec2_dot(normal, in[1].position) - offset;
    if (distance0 <= 0.0f) out[count++] = in[0];
    if (distance1 <= 0.0f) out[count++] = in[1];
    if (distance0 * distance1 < 0.0f) {
        float t = distance0 / (distance0 - distance1);
        ClipVertex cut = distance0 > 0.0f ? in[0] : in[1];
        cut.position = vec2_add(in[0].position, vec2_scale(t, vec2_sub(in[1].position, in[0].position)));
        if (distance0 > 0.0f) {
            cut.in_reference = (uint8_t)clip_edge;
            cut.in_incident = NO_EDGE;
        } else {
            cut.out_reference = (uint8_t)clip_edge;
            cut.out_incident = NO_EDGE;
        }
        out[count++] = cut;
    }
    return count == 2;
}

/* Returns the separation along the reference face. Inlined, so that contacts by all faces without a gap cost no more
   than if there were no others. */
static inline __attribute__((always_inline)) float compute(Manifold *manifold, const Box *a, const Box *b,
                                                           const Vec2 *across, float gap, const Vec2 *last) {
    manifold->count = 0;
    ReferenceFace face;
    if (!find_reference_face(&face, a, b, across, gap, last)) return INFINITY;
    manifold->normal = face.normal;

    const Box *reference = face.of_b ? b : a, *incident = face.of_b ? a : b;
    Vec2 front_normal = face.of_b ? vec2_negate(face.normal) : face.normal;
    Vec2 side_normal = face.along_y ? reference->rotation.column1 : reference->rotation.column2;
    float front_half = face.along_y ? reference->half.y : reference->half.x;
    float side_half = face.along_y ? reference->half.x : reference->half.y;
    float front = vec2_dot(reference->position, front_normal) + front_half;
    float side = vec2_dot(reference->position, side_normal);

    ClipVertex edge[2], half_clipped[2], clipped[2];
    find_incident_edge(edge, incident, front_normal);
    if (!clip(half_clipped, edge, vec2_negate(side_normal), -side + side_half, face.along_y ? EDGE_LEFT : EDGE_BOTTOM))
        return face.separation;
    if (!clip(clipped, half_clipped, side_normal, side + side_half, face.along_y ? EDGE_RIGHT : EDGE_TOP))
        return face.separation;

    for (int i = 0; i < 2; i++) {
        float separation = vec2_dot(front_normal, clipped[i].position) - front;
        if (separation > gap) continue;
        /* Projected onto the reference face, so that both lever arms end in the same point. */
        Vec2 position = vec2_sub(clipped[i].position, vec2_scale(separation, front_normal));
        const uint32_t of_reference = clipped[i].in_reference | (uint32_t)clipped[i].out_reference << 8;
        const uint32_t of_incident = clipped[i].in_incident | (uint32_t)clipped[i].out_incident << 8;
        const uint32_t feature = face.of_b ? of_incident | of_reference << 16 : of_reference | of_incident << 16;
        manifold->points[manifold->count++] = (ManifoldPoint){position, separation, feature};
    }
    return face.separation;
}

void manifold_compute(Manifold *manifold, const Box *a, const Box *b) { compute(manifold, a, b, NULL, 0.0f, NULL); }

void manifold_compute_within(Manifold *manifold, const Box *a, const Box *b, float gap, const Vec2 *last) {
    compute(manifold, a, b, NULL, gap, last);
}

float manifold_compute_across(Manifold *manifold, const Box *a, const Box *b, float gap, Vec2 normal) {
    return compute(manifold, a, b, &normal, gap, NULL);
}
