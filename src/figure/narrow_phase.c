/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/narrow_phase.h"

#include <math.h>

bool collision_find(Collision *collision) {
    const Box *a = &collision->boxes[0], *b = &collision->boxes[1];
    const float same_way = 0.9999f;
    manifold_compute(&collision->manifold, a, b);
    separating_axes(collision->overlaps, a, b);
    if (collision->manifold.count == 0) return false;
    /* The axis of the normal, which need not have the least overlap: for coherence the engine keeps an axis that is
       nearly the least. */
    collision->least = -1;
    for (int i = 0; i < SEPARATING_AXES; i++) {
        const AxisOverlap *overlap = &collision->overlaps[i];
        if (fabsf(vec2_dot(overlap->axis, collision->manifold.normal)) <= same_way) continue;
        if (collision->least < 0 || overlap->depth < collision->overlaps[collision->least].depth) collision->least = i;
    }
    if (collision->least < 0) return false;
    collision->normal = collision->manifold.normal;
    collision->label =
        collision->least == least_overlap(collision->overlaps) ? "smallest overlap" : "near-smallest overlap";
    return true;
}

Vec2 collision_turn_up(Collision *collision) {
    Manifold *manifold = &collision->manifold;
    const float side = collision->overlaps[collision->least].box == 0 ? 1.0f : -1.0f;
    const Vec2 front = vec2_scale(side, manifold->normal);
    const Mat22 turn = {{front.y, front.x}, {-front.x, front.y}};
    for (int i = 0; i < 2; i++) {
        Box *box = &collision->boxes[i];
        box->position = mat22_multiply(turn, box->position);
        box->rotation.column1 = mat22_multiply(turn, box->rotation.column1);
        box->rotation.column2 = mat22_multiply(turn, box->rotation.column2);
    }
    manifold->normal = mat22_multiply(turn, manifold->normal);
    for (int i = 0; i < manifold->count; i++)
        manifold->points[i].position = mat22_multiply(turn, manifold->points[i].position);
    /* Overlaps along the axes do not change: they are measured from the origin. */
    for (int i = 0; i < SEPARATING_AXES; i++)
        collision->overlaps[i].axis = mat22_multiply(turn, collision->overlaps[i].axis);
    return mat22_multiply(turn, vec2(0, -1));
}

void draw_collision_boxes(Sketch *sketch, const View *view, const Collision *collision) {
    for (int i = 0; i < 2; i++) {
        const Pen pen = pen_fill(fill_of(collision, i), is_bomb(collision, i) ? 0.28 : 0.13, ink_of(collision, i));
        sketch_box(sketch, view, &collision->boxes[i], &pen);
    }
}
