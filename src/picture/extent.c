/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "picture/extent.h"

#include <math.h>

const Extent extent_empty = {HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};

bool extent_is_empty(const Extent *extent) { return !(extent->left <= extent->right && extent->bottom <= extent->top); }

void extent_include(Extent *extent, const Trajectory *run, int frame, int body) {
    size_t i = (size_t)frame * (size_t)run->bodies + (size_t)body;
    double x = run->position[i].x, y = run->position[i].y, angle = run->angle[i];
    double c = fabs(cos(angle)), s = fabs(sin(angle));
    double half_x = run->size[body].x / 2.0, half_y = run->size[body].y / 2.0;
    double reach_x = c * half_x + s * half_y, reach_y = s * half_x + c * half_y;
    if (!(fabs(x) + reach_x < EXTENT_FARTHEST && fabs(y) + reach_y < EXTENT_FARTHEST)) return; /* nor for NaN */
    extent->left = fmin(extent->left, x - reach_x), extent->right = fmax(extent->right, x + reach_x);
    extent->bottom = fmin(extent->bottom, y - reach_y), extent->top = fmax(extent->top, y + reach_y);
}
