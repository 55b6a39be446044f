/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Narrow phase: two boxes -> the points where they touch. Separating axes, then clipping of the incident edge
   (Catto, "Fast and Simple Physics using Sequential Impulses", GDC 2006). */
#pragma once
#include "common/vec2.h"

#include <stdint.h>

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
    float separation; /* m, <= 0 */
    uint32_t feature; /* bytes from the lowest: incoming and outgoing edge of a, then of b */
} ManifoldPoint;

typedef struct Manifold {
    int count;   /* 0..2 */
    Vec2 normal; /* unit, from a to b */
    ManifoldPoint points[2];
} Manifold;

/* Fills the manifold of a and b; count is 0 if they do not touch. */
void manifold_compute(Manifold *manifold, const Box *a, const Box *b);
