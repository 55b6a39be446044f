/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The two halves of a picture of a collision: overlaps along the axes of both boxes, and a close-up of the contact. */
#include "engine/engine.h"
#include "figures/figure.h"
#include "figures/sketch.h"
#include "pictures/picture.h"
#include "pixels/png.h"
#include "pixels/type.h"

#include <math.h>
#include <stdio.h>

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

/* Draws both boxes, translucent, so that their overlap is visible. */
static void draw_collision_boxes(Sketch *sketch, const View *view, const Collision *collision) {
    for (int i = 0; i < 2; i++) {
        const Pen pen = pen_fill(fill_of(collision, i), is_bomb(collision, i) ? 0.28 : 0.13, ink_of(collision, i));
        sketch_box(sketch, view, &collision->boxes[i], &pen);
    }
}

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
static View narrow_phase_contact_look_at(View view, const Vec2 edges[2][2]) {
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
    const View view = narrow_phase_contact_look_at(window, (const Vec2(*)[2])edges);
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

/* Where the projections on an axis are drawn: maps positions on the axis to the page. */
typedef struct Gauge {
    Point from; /* position 0, on the line closer to the boxes */
    Vec2 along, out;
    double scale;
} Gauge;

static Point gauge_point(const Gauge *gauge, double place, double off) {
    double x = (double)gauge->along.x, y = (double)gauge->along.y;
    return (Point){gauge->from.x + place * gauge->scale * x + off * (double)gauge->out.x,
                   gauge->from.y + place * gauge->scale * y + off * (double)gauge->out.y};
}

static void draw_bar(Sketch *sketch, const Gauge *gauge, double low, double high, double off, const Pen *pen) {
    const double thick = 1.5;
    const Point corners[] = {gauge_point(gauge, low, off), gauge_point(gauge, high, off),
                             gauge_point(gauge, high, off + thick), gauge_point(gauge, low, off + thick)};
    sketch_shape(sketch, corners, 4, pen);
}

/* The gauge of an axis is outside the boxes, on the side of the box that owns the axis. */
static Gauge place_gauge(const View *view, const Collision *collision, const AxisOverlap *overlap) {
    Vec2 out = vec2_cross_scalar(overlap->axis, 1);
    Vec2 own = collision->boxes[overlap->box].position, other = collision->boxes[1 - overlap->box].position;
    /* Across the pair, the owning box determines the side; along the pair, both sides have room. */
    double side = (double)vec2_dot(vec2_sub(own, other), out);
    if (fabs(side) < 0.5) side = overlap->box == 0 ? -(double)out.x : (double)out.x;
    if (side < 0) out = vec2_negate(out);
    double reach = -HUGE_VAL;
    for (int i = 0; i < 2; i++) {
        const Box *box = &collision->boxes[i];
        Vec2 in_box = vec2_abs(mat22_multiply(mat22_transpose(box->rotation), out));
        reach = fmax(reach, (double)(vec2_dot(box->position, out) + vec2_dot(in_box, box->half)));
    }
    Point origin = view_place(view, vec2(0, 0));
    /* At different distances for the two boxes, so that their tilted bars do not meet. */
    double away = view->scale * reach + (overlap->box == 0 ? 7 : 3);
    return (Gauge){{origin.x + away * (double)out.x, origin.y + away * (double)out.y}, overlap->axis, out, view->scale};
}

/* Lines from the ends of the least overlap to the boxes. */
static void draw_guides(Sketch *sketch, const Gauge *gauge, const double ends[2]) {
    const Pen pen = pen_line(INK_SOFT, 1.2, "(4,4)");
    for (int i = 0; i < 2; i++)
        sketch_line(sketch, gauge_point(gauge, ends[i], 0), gauge_point(gauge, ends[i], -1.1 * gauge->scale), &pen);
}

enum { DEPTH_TEXT_SIZE = 64 };

static void format_depth(char text[DEPTH_TEXT_SIZE], const Collision *collision, int i) {
    const AxisOverlap *overlap = &collision->overlaps[i];
    snprintf(text, DEPTH_TEXT_SIZE, "%s %c: %.0f mm", name_of(collision, overlap->box), overlap->letter,
             1000 * overlap->depth);
}

static double depth_points(const Collision *collision, int i) {
    return (i == collision->least ? 1.13 : 0.94) * collision->points;
}

/* From this window width on, labels fit beside vertical bars; otherwise they run along them. */
static const double wide = 100; /* mm, for a font size of 8 points */

static bool has_room_beside(const View *view, const Collision *collision) {
    return view->high.x - view->low.x >= wide * collision->points / 8;
}

/* Beside a vertical bar, along a horizontal one. */
static void draw_depth(Sketch *sketch, const View *view, const Gauge *gauge, double place, const Collision *collision,
                       int i) {
    const bool beside = fabsf(gauge->out.x) > fabsf(gauge->out.y) && has_room_beside(view, collision);
    const double step = 3.8 * collision->points / 8;
    TextStyle words = {depth_points(collision, i), TEXT_CENTER, INK, 0, true};
    if (beside) words.align = gauge->out.x > 0 ? TEXT_LEFT : TEXT_RIGHT;
    if (!beside) words.degrees = atan((double)(gauge->along.y / gauge->along.x)) * 180 / M_PI;
    if (words.degrees < -80) words.degrees += 180; /* all vertical labels read in the same direction */
    Point at = gauge_point(gauge, place, 6.2);
    char text[DEPTH_TEXT_SIZE];
    format_depth(text, collision, i);
    sketch_text(sketch, at, &words, "%s", text);
    if (i != collision->least) return;
    words.points = 0.94 * collision->points;
    at = beside ? (Point){at.x, at.y - step} : gauge_point(gauge, place, 6.2 + step);
    sketch_text(sketch, at, &words, "%s", collision->label);
}

static void draw_gauge(Sketch *sketch, const View *view, const Collision *collision, int i) {
    const AxisOverlap *overlap = &collision->overlaps[i];
    const Gauge gauge = place_gauge(view, collision, overlap);
    bool least = i == collision->least;
    for (int k = 0; k < 2; k++) {
        const Pen pen = pen_fill(fill_of(collision, k), is_bomb(collision, k) ? 0.85 : 0.35, ink_of(collision, k));
        draw_bar(sketch, &gauge, overlap->low[k], overlap->high[k], 1.9 * k, &pen);
    }
    int upper = overlap->high[0] - overlap->low[1] < overlap->high[1] - overlap->low[0] ? 0 : 1;
    const double ends[2] = {overlap->low[1 - upper], overlap->high[upper]};
    const Point corners[] = {gauge_point(&gauge, ends[0], -0.7), gauge_point(&gauge, ends[1], -0.7),
                             gauge_point(&gauge, ends[1], 4.1), gauge_point(&gauge, ends[0], 4.1)};
    const Pen mark = pen_line(ACCENT, least ? 5 : 1.8, NULL);
    sketch_shape(sketch, corners, 4, &mark);
    if (least) draw_guides(sketch, &gauge, ends);
    draw_depth(sketch, view, &gauge, (ends[0] + ends[1]) / 2, collision, i);
}

/* Leaves room for the gauges and their labels around the boxes. */
static View narrow_phase_overlaps_look_at(View view, const Collision *collision) {
    const double gauges = 14, above = 27 + collision->points;
    double words = 8 * collision->points / 8;
    for (int i = 0; has_room_beside(&view, collision) && i < SEPARATING_AXES; i++) {
        char text[DEPTH_TEXT_SIZE];
        format_depth(text, collision, i);
        words = fmax(words, type_width(text, depth_points(collision, i)));
    }
    const double beside = 2 * (gauges + words);
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < 2; i++) {
        const Box *box = &collision->boxes[i];
        const Vec2 x = vec2_scale(box->half.x, box->rotation.column1),
                   y = vec2_scale(box->half.y, box->rotation.column2);
        const double reach[2] = {fabs((double)x.x) + fabs((double)y.x), fabs((double)x.y) + fabs((double)y.y)};
        const double at[2] = {(double)box->position.x, (double)box->position.y};
        for (int k = 0; k < 2; k++) low[k] = fmin(low[k], at[k] - reach[k]), high[k] = fmax(high[k], at[k] + reach[k]);
    }
    view.center = (Point){(low[0] + high[0]) / 2, (low[1] + high[1]) / 2};
    view.scale = fmin((view.high.x - view.low.x - beside) / (high[0] - low[0]),
                      (view.high.y - view.low.y - above) / (high[1] - low[1]));
    return view;
}

void draw_overlaps(Sketch *sketch, View window, const Collision *collision) {
    const View view = narrow_phase_overlaps_look_at(window, collision);
    draw_collision_boxes(sketch, &view, collision);
    for (int i = 0; i < SEPARATING_AXES; i++) draw_gauge(sketch, &view, collision, i);
    for (int i = 0; i < 2; i++) {
        const TextStyle words = {1.06 * collision->points, TEXT_CENTER, ink_of(collision, i), 0, false};
        sketch_text(sketch, view_place(&view, collision->boxes[i].position), &words, "%s", name_of(collision, i));
    }
    sketch_scale_bar(sketch, (Point){view.low.x + 3, view.low.y + 5}, view.scale, round_down(14 / view.scale), "m",
                     0.94 * collision->points);
}
