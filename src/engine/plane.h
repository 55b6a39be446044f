/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Plane vectors and rotations in float32. The order of every operation here is part of the engine's result:
   the trajectories are compared bit by bit. */
#pragma once
#include <math.h>

typedef struct Vec2 {
    float x, y;
} Vec2;

/* Column-major 2 x 2 matrix: a rotation has columns (c, s) and (-s, c). */
typedef struct Mat22 {
    Vec2 column1, column2;
} Mat22;

static inline Vec2 vec2(float x, float y) { return (Vec2){x, y}; }
static inline Vec2 vec2_add(Vec2 a, Vec2 b) { return vec2(a.x + b.x, a.y + b.y); }
static inline Vec2 vec2_sub(Vec2 a, Vec2 b) { return vec2(a.x - b.x, a.y - b.y); }
static inline Vec2 vec2_scale(float s, Vec2 v) { return vec2(s * v.x, s * v.y); }
static inline Vec2 vec2_negate(Vec2 v) { return vec2(-v.x, -v.y); }
static inline Vec2 vec2_abs(Vec2 v) { return vec2(fabsf(v.x), fabsf(v.y)); }
static inline float vec2_dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }

/* z component of a x b. */
static inline float vec2_cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }

/* v x (s out of the plane): for a unit normal and s = 1 the tangent, a quarter turn clockwise. */
static inline Vec2 vec2_cross_scalar(Vec2 v, float s) { return vec2(s * v.y, -s * v.x); }

/* Not hypot: square roots are the same on every machine, and squares of floats do not overflow a double. */
static inline double vec2_distance(Vec2 a, Vec2 b) {
    const double x = (double)a.x - (double)b.x, y = (double)a.y - (double)b.y;
    return sqrt(x * x + y * y);
}

/* (s out of the plane) x v: the velocity that spin s gives to a point at lever arm v. */
static inline Vec2 scalar_cross_vec2(float s, Vec2 v) { return vec2(-s * v.y, s * v.x); }

static inline Vec2 mat22_multiply(Mat22 m, Vec2 v) {
    return vec2(m.column1.x * v.x + m.column2.x * v.y, m.column1.y * v.x + m.column2.y * v.y);
}

static inline Mat22 mat22_transpose(Mat22 m) {
    return (Mat22){vec2(m.column1.x, m.column2.x), vec2(m.column1.y, m.column2.y)};
}

/* a * b */
static inline Mat22 mat22_product(Mat22 a, Mat22 b) {
    return (Mat22){mat22_multiply(a, b.column1), mat22_multiply(a, b.column2)};
}

static inline Mat22 mat22_abs(Mat22 m) { return (Mat22){vec2_abs(m.column1), vec2_abs(m.column2)}; }

/* The double function rounded to float, so that the result does not depend on a maths library's sinf. */
static inline Mat22 mat22_rotation(float angle) {
    float c = (float)cos((double)angle), s = (float)sin((double)angle);
    return (Mat22){vec2(c, s), vec2(-s, c)};
}
