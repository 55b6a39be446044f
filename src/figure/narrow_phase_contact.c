/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/narrow_phase.h"

#include <math.h>

/* Side of a box that faces a direction most: its ends. */
static void facing_edge(Vec2 ends[2], const Box *box, Vec2 direction) {
    Vec2 in_box = mat22_multiply(mat22_transpose(box->rotation), direction);
    bool along_y = fabsf(in_box.y) > fabsf(in_box.x);
    float front = along_y ? copysignf(box->half.y, in_box.y) : copysignf(box->half.x, in_box.x);
    for (int i = 0; i < 2; i++) {
        float side = (i == 0 ? -1.0f : 1.0f) * (along_y ? box->half.x : box->half.y);
        Vec2 local = along_y ? vec2(side, front) : vec2(front, side);
        ends[i] = vec2_add(box->position, mat22_multiply(box->rotation, local));
    }
}

/* The box whose axis the manifold's normal lies on. */
static int reference_of(const Collision *collision) { return collision->overlaps[collision->least].box; }

/* Words along an edge, `share` of the way from its left end, off it in the direction `off`. */
static void put_edge_name(Sketch *sketch, const View *view, const Vec2 ends[2], double share, Vec2 off, uint32_t colour,
                          const char *words) {
    Point p = view_place(view, ends[0]), q = view_place(view, ends[1]);
    if (p.x > q.x) {
        Point swap = p;
        p = q;
        q = swap;
    }
    const TextStyle style = {7.5, TEXT_CENTER, colour, atan2(q.y - p.y, q.x - p.x) * 180 / M_PI, false};
    const Point at = {p.x + share * (q.x - p.x) + 2.4 * (double)off.x, p.y + share * (q.y - p.y) + 2.4 * (double)off.y};
    sketch_text(sketch, at, &style, "%s", words);
}

/* What the incident edge is cut off at: it goes on along `front` through an end of the reference edge. */
static void put_side_plane(Sketch *sketch, const View *view, Vec2 end, Vec2 out, Vec2 front) {
    const Pen pen = pen_line(INK_SOFT, 1.6, "(6,6)");
    const Vec2 ends[2] = {vec2_add(end, vec2_scale(-0.3f, front)), vec2_add(end, vec2_scale(0.26f, front))};
    sketch_line(sketch, view_place(view, ends[0]), view_place(view, ends[1]), &pen);
    if (out.x <= 0) return;
    put_edge_name(sketch, view, ends, 0.78, vec2_scale(1 / hypotf(out.x, out.y), out), INK_SOFT, "side plane");
}

static void put_edges(Sketch *sketch, const View *view, const Collision *collision, Vec2 front) {
    Vec2 ends[2];
    int reference = reference_of(collision);
    uint32_t ink = ink_of(collision, reference), other_ink = ink_of(collision, 1 - reference);
    facing_edge(ends, &collision->boxes[reference], front);
    for (int i = 0; i < 2; i++) put_side_plane(sketch, view, ends[i], vec2_sub(ends[i], ends[1 - i]), front);
    const Pen thick = pen_line(ink, 5, NULL), dashed = pen_line(other_ink, 4, "(9,4)");
    sketch_line(sketch, view_place(view, ends[0]), view_place(view, ends[1]), &thick);
    put_edge_name(sketch, view, ends, 0.22, front, ink, "reference edge");
    facing_edge(ends, &collision->boxes[1 - reference], vec2_negate(front));
    sketch_line(sketch, view_place(view, ends[0]), view_place(view, ends[1]), &dashed);
    put_edge_name(sketch, view, ends, 0.5, vec2_negate(front), other_ink, "incident edge");
}

/* A point's depth is written below it, toward the middle of the edge. */
static void put_points(Sketch *sketch, const View *view, const Collision *collision, Vec2 front) {
    const Pen dot = pen_fill(ACCENT, 1, NO_COLOUR), ring = {0xFFFFFF, 1, ACCENT, 1.6, NULL};
    const Pen depth = pen_line(ACCENT, 1.8, NULL);
    for (int i = 0; i < collision->manifold.count; i++) {
        const ManifoldPoint *point = &collision->manifold.points[i];
        Point on_face = view_place(view, point->position);
        Point deep = view_place(view, vec2_add(point->position, vec2_scale(point->separation, front)));
        sketch_line(sketch, on_face, deep, &depth);
        sketch_dot(sketch, deep, 1.1, &dot);
        sketch_dot(sketch, on_face, 0.9, &ring);
        bool left = deep.x < (view->low.x + view->high.x) / 2;
        const TextStyle words = {8.5, left ? TEXT_LEFT : TEXT_RIGHT, ACCENT, 0, false};
        sketch_text(sketch, (Point){deep.x + (left ? -1 : -2.5), deep.y - 4}, &words, "%s mm",
                    show_decimals(1000 * (double)point->separation, 0).text);
    }
}

/* Out of the reference edge; written as the engine has it, from a to b. */
static void put_normal(Sketch *sketch, const View *view, Vec2 foot, Vec2 front, Vec2 normal) {
    const Point from = view_place(view, foot), to = view_place(view, vec2_add(foot, vec2_scale(0.35f, front)));
    sketch_arrow(sketch, from, to, HEAD_AT_END, ACCENT, 3);
    const TextStyle words = {8.5, TEXT_CENTER, ACCENT, 0, false};
    sketch_text(sketch, (Point){to.x, to.y + 3}, &words, "normal (%s, %s)", show_decimals((double)normal.x, 3).text,
                show_decimals((double)normal.y, 3).text);
}

void put_contact(Sketch *sketch, View view, const Collision *collision) {
    const Manifold *manifold = &collision->manifold;
    int reference = reference_of(collision);
    Vec2 front = reference == 0 ? manifold->normal : vec2_negate(manifold->normal), ends[2];
    facing_edge(ends, &collision->boxes[reference], front);
    Vec2 middle = vec2_scale(0.5f, vec2_add(ends[0], ends[1]));
    view.center = (Point){(double)middle.x, (double)middle.y};
    view.scale = 60;
    put_collision(sketch, &view, collision);
    put_edges(sketch, &view, collision, front);
    put_points(sketch, &view, collision, front);
    put_normal(sketch, &view, middle, front, manifold->normal);
    for (int i = 0; i < 2; i++) {
        const TextStyle name = {8.5, TEXT_CENTER, ink_of(collision, i), 0, false};
        Vec2 at = vec2_add(middle, vec2_scale(i == reference ? -0.45f : 0.55f, front));
        sketch_text(sketch, view_place(&view, at), &name, "%s", name_of(collision, i));
    }
    sketch_bar(sketch, (Point){view.low.x + 4, view.low.y + 4}, 0.2 * view.scale, "0.2 m");
    sketch_rectangle(sketch, view.low, view.high, &(Pen){NO_COLOUR, 1, FRAME, 1.8, NULL});
}
