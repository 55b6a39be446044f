/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/separating_axes.h"

#include <math.h>

static double dot(Vec2 a, Vec2 b) { return (double)a.x * (double)b.x + (double)a.y * (double)b.y; }

static void project_box(AxisOverlap *overlap, int i, const Box *box) {
    double middle = dot(box->position, overlap->axis);
    double reach = (double)box->half.x * fabs(dot(box->rotation.column1, overlap->axis)) +
                   (double)box->half.y * fabs(dot(box->rotation.column2, overlap->axis));
    overlap->low[i] = middle - reach;
    overlap->high[i] = middle + reach;
}

void separating_axes(AxisOverlap overlaps[SEPARATING_AXES], const Box *a, const Box *b) {
    for (int i = 0; i < SEPARATING_AXES; i++) {
        AxisOverlap *overlap = &overlaps[i];
        const Mat22 *rotation = i < 2 ? &a->rotation : &b->rotation;
        overlap->box = i / 2;
        overlap->letter = i % 2 == 0 ? 'x' : 'y';
        overlap->axis = i % 2 == 0 ? rotation->column1 : rotation->column2;
        project_box(overlap, 0, a);
        project_box(overlap, 1, b);
        overlap->depth = fmin(overlap->high[0] - overlap->low[1], overlap->high[1] - overlap->low[0]);
    }
}

int least_overlap(const AxisOverlap overlaps[SEPARATING_AXES]) {
    int least = 0;
    for (int i = 1; i < SEPARATING_AXES; i++)
        if (overlaps[i].depth < overlaps[least].depth) least = i;
    return least;
}
