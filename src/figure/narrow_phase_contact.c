/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/narrow_phase.h"
#include "type/type.h"

#include <math.h>

/* The ends of the side of a box that faces a direction most. */
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

/* The box whose axis is the manifold's normal. */
static int reference_of(const Collision *collision) { return collision->overlaps[collision->least].box; }

static float length_of(const Vec2 ends[2]) { return hypotf(ends[1].x - ends[0].x, ends[1].y - ends[0].y); }

/* The edges that face each other, the reference edge first. */
static void find_edges(const Collision *collision, Vec2 front, Vec2 edges[2][2]) {
    int reference = reference_of(collision);
    facing_edge(edges[0], &collision->boxes[reference], front);
    facing_edge(edges[1], &collision->boxes[1 - reference], vec2_negate(front));
}

/* The length (m) that sizes in the picture are relative to. */
static float unit_of(const Vec2 edges[2][2]) { return fmaxf(length_of(edges[0]), length_of(edges[1])); }

/* Text along an edge, at `share` of its length from the left end, displaced along `off`. */
static void draw_edge_label(Sketch *sketch, const View *view, const Vec2 ends[2], double share, Vec2 off,
                            TextStyle style, const char *words) {
    Point p = view_place(view, ends[0]), q = view_place(view, ends[1]);
    if (p.x > q.x) {
        Point swap = p;
        p = q;
        q = swap;
    }
    style.degrees = atan2(q.y - p.y, q.x - p.x) * 180 / M_PI;
    const Point at = {p.x + share * (q.x - p.x) + 2.4 * (double)off.x, p.y + share * (q.y - p.y) + 2.4 * (double)off.y};
    sketch_text(sketch, at, &style, "%s", words);
}

/* The plane that clips the incident edge: through an end of the reference edge, along `front`. */
static void draw_side_plane(Sketch *sketch, const View *view, Vec2 end, Vec2 out, Vec2 front, float unit,
                            double points) {
    const Pen pen = pen_line(INK_SOFT, 1.6, "(6,6)");
    const Vec2 ends[2] = {vec2_add(end, vec2_scale(-0.3f * unit, front)),
                          vec2_add(end, vec2_scale(0.26f * unit, front))};
    sketch_line(sketch, view_place(view, ends[0]), view_place(view, ends[1]), &pen);
    if (out.x <= 0) return;
    draw_edge_label(sketch, view, ends, 0.78, vec2_scale(1 / hypotf(out.x, out.y), out),
                    (TextStyle){0.94 * points, TEXT_CENTER, INK_SOFT, 0, false}, "side plane");
}

/* The contact points on the page. `near`: so close that their depths are written outward. */
typedef struct ShownPoints {
    Point deep[2], on_face[2];
    bool near;
    double middle; /* mm, mean x */
} ShownPoints;

static ShownPoints show_points(const View *view, const Collision *collision, Vec2 front) {
    const Manifold *manifold = &collision->manifold;
    ShownPoints shown = {.middle = 0};
    for (int i = 0; i < manifold->count; i++) {
        const ManifoldPoint *point = &manifold->points[i];
        shown.on_face[i] = view_place(view, point->position);
        shown.deep[i] = view_place(view, vec2_add(point->position, vec2_scale(point->separation, front)));
        shown.middle += shown.deep[i].x / manifold->count;
    }
    const double least = 2 * type_width("-999 mm", 1.06 * collision->points);
    shown.near = manifold->count < 2 || fabs(shown.deep[1].x - shown.deep[0].x) < least;
    return shown;
}

/* The name of an edge is outside its box if there is room between the points, otherwise inside, away from them. */
static void label_edge(Sketch *sketch, const View *view, const Vec2 ends[2], double share, Vec2 out,
                       const ShownPoints *points, TextStyle style, const char *words) {
    const double middle = (view_place(view, ends[0]).x + view_place(view, ends[1]).x) / 2;
    if (points->near) share = points->middle > middle ? 0.3 : 0.7;
    draw_edge_label(sketch, view, ends, share, points->near ? vec2_negate(out) : out, style, words);
}

static void draw_edges(Sketch *sketch, const View *view, const Collision *collision, Vec2 front,
                       const Vec2 edges[2][2]) {
    const double points = 0.94 * collision->points;
    const int reference = reference_of(collision);
    const uint32_t ink = ink_of(collision, reference), other_ink = ink_of(collision, 1 - reference);
    const ShownPoints shown = show_points(view, collision, front);
    for (int i = 0; i < 2; i++)
        draw_side_plane(sketch, view, edges[0][i], vec2_sub(edges[0][i], edges[0][1 - i]), front, unit_of(edges),
                        collision->points);
    const Pen thick = pen_line(ink, 5, NULL), dashed = pen_line(other_ink, 4, "(9,4)");
    sketch_line(sketch, view_place(view, edges[0][0]), view_place(view, edges[0][1]), &thick);
    label_edge(sketch, view, edges[0], 0.22, front, &shown, (TextStyle){points, TEXT_CENTER, ink, 0, true},
               "reference edge");
    sketch_line(sketch, view_place(view, edges[1][0]), view_place(view, edges[1][1]), &dashed);
    label_edge(sketch, view, edges[1], 0.5, vec2_negate(front), &shown,
               (TextStyle){points, TEXT_CENTER, other_ink, 0, true}, "incident edge");
}

/* A point's depth is below it: towards the middle of the edge, but outward if two points are close. */
static void draw_points(Sketch *sketch, const View *view, const Collision *collision, Vec2 front) {
    const Pen dot = pen_fill(ACCENT, 1, NO_COLOUR), ring = {0xFFFFFF, 1, ACCENT, 1.6, NULL};
    const Pen depth = pen_line(ACCENT, 1.8, NULL);
    const Manifold *manifold = &collision->manifold;
    const ShownPoints shown = show_points(view, collision, front);
    const bool pair = shown.near && manifold->count == 2;
    for (int i = 0; i < manifold->count; i++) {
        const Point deep = shown.deep[i];
        sketch_line(sketch, shown.on_face[i], deep, &depth);
        sketch_dot(sketch, deep, 1.1, &dot);
        sketch_dot(sketch, shown.on_face[i], 0.9, &ring);
        const bool left = pair ? deep.x < shown.deep[1 - i].x : deep.x < (view->low.x + view->high.x) / 2;
        const double off = pair ? (left ? -1.5 : 1.5) : left ? -1 : -2.5;
        const TextStyle words = {1.06 * collision->points, left != pair ? TEXT_LEFT : TEXT_RIGHT, ACCENT, 0, true};
        sketch_text(sketch, (Point){deep.x + off, deep.y - 4 * collision->points / 8}, &words, "%s mm",
                    show_decimals(1000 * (double)manifold->points[i].separation, 0).text);
    }
}

/* Starts at the reference edge; the numbers are the engine's normal, from a to b. */
static void draw_normal(Sketch *sketch, const View *view, const Collision *collision, Vec2 foot, Vec2 way) {
    const Vec2 normal = collision->normal;
    const Point from = view_place(view, foot), to = view_place(view, vec2_add(foot, way));
    const double length = hypot(to.x - from.x, to.y - from.y);
    sketch_arrow(sketch, from, to, HEAD_AT_END, ACCENT, 3);
    /* beyond the tip, by half a line of text */
    const double off = 3 * collision->points / 8;
    const Point at = {to.x + off * (to.x - from.x) / length, to.y + off * (to.y - from.y) / length};
    const TextStyle words = {1.06 * collision->points, TEXT_CENTER, ACCENT, 0, true};
    sketch_text(sketch, at, &words, "normal (%s, %s)", show_decimals((double)normal.x, 3).text,
                show_decimals((double)normal.y, 3).text);
}

static double between(double a, double b) { return (a + b) / 2; }

/* Both edges are in the window, with a margin. */
static View look_at(View view, const Vec2 edges[2][2]) {
    const double around = 1.27;
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < 4; i++) {
        const Vec2 end = edges[i / 2][i % 2];
        low[0] = fmin(low[0], (double)end.x), high[0] = fmax(high[0], (double)end.x);
        low[1] = fmin(low[1], (double)end.y), high[1] = fmax(high[1], (double)end.y);
    }
    const double side = fmax(fmax(high[0] - low[0], high[1] - low[1]), (double)unit_of(edges));
    view.center = (Point){between(low[0], high[0]), between(low[1], high[1])};
    view.scale = fmin(view.high.x - view.low.x, view.high.y - view.low.y) / (around * side);
    return view;
}

/* Between an edge's middle and its box's centre; the upper one above the normal's label. */
static void draw_box_names(Sketch *sketch, const View *view, const Collision *collision, const Vec2 edges[2][2],
                           Vec2 front) {
    const int reference = reference_of(collision);
    const Vec2 foot = vec2_scale(0.5f, vec2_add(edges[0][0], edges[0][1]));
    for (int i = 0; i < 2; i++) {
        const int box = i == 0 ? reference : 1 - reference;
        const Vec2 middle = vec2_scale(0.5f, vec2_add(edges[i][0], edges[i][1]));
        const Vec2 in = vec2_sub(collision->boxes[box].position, middle);
        const float up = (i == 0 ? -0.5f : 0.57f) * unit_of(edges) - vec2_dot(vec2_sub(middle, foot), front);
        const float share = fminf(fmaxf(up / vec2_dot(in, front), 0.3f), 1.2f);
        const TextStyle name = {1.06 * collision->points, TEXT_CENTER, ink_of(collision, box), 0, true};
        sketch_text(sketch, view_place(view, vec2_add(middle, vec2_scale(share, in))), &name, "%s",
                    name_of(collision, box));
    }
}

void draw_contact_closeup(Sketch *sketch, View window, const Collision *collision) {
    const Manifold *manifold = &collision->manifold;
    int reference = reference_of(collision);
    Vec2 front = reference == 0 ? manifold->normal : vec2_negate(manifold->normal), edges[2][2];
    find_edges(collision, front, edges);
    const View view = look_at(window, (const Vec2(*)[2])edges);
    const float unit = unit_of((const Vec2(*)[2])edges);
    const Vec2 middle = vec2_scale(0.5f, vec2_add(edges[0][0], edges[0][1]));
    draw_collision_boxes(sketch, &view, collision);
    draw_edges(sketch, &view, collision, front, (const Vec2(*)[2])edges);
    draw_points(sketch, &view, collision, front);
    draw_normal(sketch, &view, collision, middle, vec2_scale(0.33f * unit, front));
    draw_box_names(sketch, &view, collision, (const Vec2(*)[2])edges, front);
    sketch_scale_bar(sketch, (Point){view.low.x + 4, view.low.y + 4}, view.scale, round_down(14 / view.scale), "m",
                     0.94 * collision->points);
    sketch_rectangle(sketch, view.low, view.high, &(Pen){NO_COLOUR, 1, FRAME, 1.8, NULL});
}
