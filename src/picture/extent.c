/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/extent.h"

#include <math.h>

const Extent extent_empty = {HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};

static size_t index_of(const Trajectory *run, int frame, int body) {
    return (size_t)frame * (size_t)run->bodies + (size_t)body;
}

bool extent_is_empty(const Extent *extent) { return !(extent->left <= extent->right && extent->bottom <= extent->top); }

double extent_side(const Extent *extent) { return fmax(extent->right - extent->left, extent->top - extent->bottom); }

Extent extent_widened(const Extent *extent, double by) {
    return (Extent){extent->left - by, extent->right + by, extent->bottom - by, extent->top + by};
}

void extent_include(Extent *extent, const Trajectory *run, int frame, int body) {
    size_t i = index_of(run, frame, body);
    double x = run->position[i].x, y = run->position[i].y, angle = run->angle[i];
    double c = fabs(cos(angle)), s = fabs(sin(angle));
    double half_x = run->size[body].x / 2.0, half_y = run->size[body].y / 2.0;
    double reach_x = c * half_x + s * half_y, reach_y = s * half_x + c * half_y;
    if (!(fabs(x) + reach_x < EXTENT_FARTHEST && fabs(y) + reach_y < EXTENT_FARTHEST)) return; /* nor for NaN */
    extent->left = fmin(extent->left, x - reach_x), extent->right = fmax(extent->right, x + reach_x);
    extent->bottom = fmin(extent->bottom, y - reach_y), extent->top = fmax(extent->top, y + reach_y);
}

/* Cuts [*first, *last] to the part of the ray at + t * direction inside a slab. */
static void clip_to_slab(double at, double direction, double half, double *first, double *last) {
    double a = (-half - at) / direction, b = (half - at) / direction;
    if (direction == 0) a = -HUGE_VAL, b = fabs(at) <= half ? HUGE_VAL : -HUGE_VAL;
    *first = fmax(*first, fmin(a, b));
    *last = fmin(*last, fmax(a, b));
}

/* The distance straight down from a point to a body; infinite if it is not below. */
static double distance_down(const Trajectory *run, int frame, int body, double x, double y) {
    size_t i = index_of(run, frame, body);
    double dx = x - (double)run->position[i].x, dy = y - (double)run->position[i].y, angle = (double)run->angle[i];
    double c = cos(angle), s = sin(angle), first = 0, last = HUGE_VAL;
    clip_to_slab(c * dx + s * dy, -s, run->size[body].x / 2.0, &first, &last);
    clip_to_slab(c * dy - s * dx, -c, run->size[body].y / 2.0, &first, &last);
    return first <= last ? first : HUGE_VAL;
}

void extent_include_ground(Extent *extent, const Trajectory *run, int frame, int body) {
    const Vec2 at = run->position[index_of(run, frame, body)];
    double down = HUGE_VAL;
    for (int other = 0; other < run->bodies; other++)
        if (run->fixed[other]) down = fmin(down, distance_down(run, frame, other, (double)at.x, (double)at.y));
    if (fabs((double)at.y - down) < EXTENT_FARTHEST) extent->bottom = fmin(extent->bottom, (double)at.y - down);
}

bool extent_holds(const Extent *extent, const Trajectory *run, int frame, int body) {
    const Vec2 at = run->position[index_of(run, frame, body)];
    return (double)at.x >= extent->left && (double)at.x <= extent->right && (double)at.y >= extent->bottom &&
           (double)at.y <= extent->top;
}
