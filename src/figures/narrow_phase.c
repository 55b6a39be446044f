/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The two halves of a picture of a collision: overlaps along the axes of both boxes, and a close-up of the contact. */
#include "base/base.h"
#include "base/numbers.h"
#include "engine/engine.h"
#include "figures/figure.h"
#include "figures/figures_internal.h"
#include "figures/sketch.h"
#include "pictures/picture.h"
#include "pixels/png.h"
#include "pixels/type.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

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

/* The plane that clips the incident edge: through an end of the reference edge, along `front`. */
static void side_plane(Vec2 out[2], Vec2 end, Vec2 front, float unit) {
    out[0] = vec2_add(end, vec2_scale(-0.3f * unit, front));
    out[1] = vec2_add(end, vec2_scale(0.26f * unit, front));
}

/* The close-up while its labels are placed, and drawn when all have a place. */
typedef struct Closeup {
    const Collision *collision;
    View view;
    Vec2 front, edges[2][2]; /* the reference edge first */
    float unit;
    double points;             /* font size */
    Point on_face[2], deep[2]; /* of the contact points, on the page */
    Point foot, tip;           /* of the normal */
    LabelField field;
    Sketch *sketch; /* NULL while labels are placed */
} Closeup;

static const double dot_radius = 1.1, ring = 0.9; /* mm */

static void add_line(Closeup *closeup, Point from, Point to) {
    label_add_segment(&closeup->field, (Segment){from.x, from.y, to.x, to.y});
}

static void add_between(Closeup *closeup, const Vec2 ends[2]) {
    add_line(closeup, view_place(&closeup->view, ends[0]), view_place(&closeup->view, ends[1]));
}

/* What labels must not cover: edges, planes, points and the normal. */
static void add_obstacles(Closeup *closeup) {
    static const float signs[5][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
    const Collision *collision = closeup->collision;
    const View *view = &closeup->view;
    closeup->field.box_count = closeup->field.segment_count = 0;
    closeup->field.frame = (PageBox){view->low.x + 0.6, view->low.y + 0.6, view->high.x - 0.6, view->high.y - 0.6};
    for (int i = 0; i < 2; i++) {
        Vec2 corners[5], plane[2];
        const Box *box = &collision->boxes[i];
        for (int k = 0; k < 5; k++)
            corners[k] =
                vec2_add(box->position,
                         mat22_multiply(box->rotation, vec2(signs[k][0] * box->half.x, signs[k][1] * box->half.y)));
        for (int k = 0; k < 4; k++) add_between(closeup, corners + k);
        side_plane(plane, closeup->edges[0][i], closeup->front, closeup->unit);
        add_between(closeup, plane);
    }
    for (int i = 0; i < collision->manifold.count; i++) {
        const Point a = closeup->deep[i], b = closeup->on_face[i];
        add_line(closeup, a, b);
        label_add_box(&closeup->field, (PageBox){fmin(a.x, b.x) - dot_radius, fmin(a.y, b.y) - dot_radius,
                                                 fmax(a.x, b.x) + dot_radius, fmax(a.y, b.y) + dot_radius});
    }
    add_line(closeup, closeup->foot, closeup->tip);
    label_add_box(&closeup->field,
                  (PageBox){closeup->tip.x - 0.8, closeup->tip.y - 2.2, closeup->tip.x + 0.8, closeup->tip.y});
}

/* A label at a point of the picture, `clear` mm away at least, with a line to it where it is not near. */
static bool put_label(Closeup *closeup, Point at, double clear, bool left, uint32_t ink, double points, bool across,
                      const char *words) {
    const View *view = &closeup->view;
    const WrappedText text = wrap_text(points, 0.6 * (view->high.x - view->low.x), "%s", words);
    const double line = line_height(points), farthest = 60;
    PageBox box;
    Segment leader;
    bool led;
    const LabelWish wish = {at.x, at.y,   clear, 0, farthest, wrapped_width(&text) + 0.5, text.lines * line,
                            left, across, true};
    const Pen thin = pen_line(ink, 0.8, NULL);
    if (!label_place_led(&closeup->field, &wish, &box, &leader, &led)) return false;
    if (closeup->sketch == NULL) return true;
    if (led) draw_leader(closeup->sketch, &leader, &box, &thin);
    sketch_lines(closeup->sketch, (Point){(box.left + box.right) / 2, box.top - line / 2},
                 &(TextStyle){points, TEXT_CENTER, ink, 0, false}, text.text);
    return true;
}

static Point narrow_phase_along(const View *view, const Vec2 ends[2], double share) {
    const Point p = view_place(view, ends[0]), q = view_place(view, ends[1]);
    return (Point){p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)};
}

/* At the first of several places along an edge; the line crosses others only where it must. */
static bool put_edge_label(Closeup *closeup, int edge, const char *words) {
    static const double shares[] = {0.25, 0.75, 0.4, 0.6, 0.12, 0.88};
    enum { SHARES = sizeof shares / sizeof *shares };
    const Collision *collision = closeup->collision;
    const int box = edge == 0 ? reference_of(collision) : 1 - reference_of(collision);
    for (int i = 0; i < 2 * SHARES; i++)
        if (put_label(closeup, narrow_phase_along(&closeup->view, closeup->edges[edge], shares[i % SHARES]), 0.6, false,
                      ink_of(collision, box), 0.94 * closeup->points, i >= SHARES, words))
            return true;
    return false;
}

/* The numbers are the engine's normal, from a to b. */
static bool put_normal(Closeup *closeup) {
    char words[128];
    const Vec2 normal = closeup->collision->normal;
    const bool narrow = closeup->view.high.x - closeup->view.low.x < 9 * closeup->points;
    snprintf(words, sizeof words, "normal%s(%s, %s)", narrow ? "\n" : " ", show_decimals((double)normal.x, 3).text,
             show_decimals((double)normal.y, 3).text);
    return put_label(closeup, closeup->tip, 0.9, false, ACCENT, 1.06 * closeup->points, true, words);
}

static bool put_side_plane(Closeup *closeup) {
    const int right = closeup->edges[0][0].x < closeup->edges[0][1].x;
    Vec2 plane[2];
    side_plane(plane, closeup->edges[0][right], closeup->front, closeup->unit);
    return put_label(closeup, narrow_phase_along(&closeup->view, plane, 0.85), 0.6, false, INK, 0.94 * closeup->points,
                     true, "side plane");
}

static bool put_depths(Closeup *closeup) {
    const Manifold *manifold = &closeup->collision->manifold;
    for (int i = 0; i < manifold->count; i++) {
        char words[64];
        snprintf(words, sizeof words, "%s mm", show_decimals(1000 * (double)manifold->points[i].separation, 0).text);
        const bool left = manifold->count == 2 && closeup->deep[i].x < closeup->deep[1 - i].x;
        if (!put_label(closeup, closeup->deep[i], dot_radius, left, ACCENT, 1.06 * closeup->points, true, words))
            return false;
    }
    return true;
}

/* Between an edge's middle and its box's centre, or beside that with a line to it. */
static bool put_box_name(Closeup *closeup, int edge) {
    const Collision *collision = closeup->collision;
    const int box = edge == 0 ? reference_of(collision) : 1 - reference_of(collision);
    const double points = 1.06 * closeup->points, half = type_width(name_of(collision, box), points) / 2 + 0.5;
    const double up = points * MM_PER_POINT / 2;
    const Vec2 middle = vec2_scale(0.5f, vec2_add(closeup->edges[edge][0], closeup->edges[edge][1]));
    const Vec2 in = vec2_sub(collision->boxes[box].position, middle);
    for (int i = 16; i > 0; i--) {
        const Point at = view_place(&closeup->view, vec2_add(middle, vec2_scale((float)i / 16, in)));
        const PageBox place = {at.x - half, at.y - up, at.x + half, at.y + up};
        if (!label_fits(&closeup->field, &place)) continue;
        label_add_box(&closeup->field, place);
        if (closeup->sketch != NULL)
            sketch_text(closeup->sketch, at, &(TextStyle){points, TEXT_CENTER, ink_of(collision, box), 0, false}, "%s",
                        name_of(collision, box));
        return true;
    }
    for (int i = 16; i > 0; i--) {
        const Point at = view_place(&closeup->view, vec2_add(middle, vec2_scale((float)i / 16, in)));
        const PageBox place = {at.x - 0.5, at.y - 0.5, at.x + 0.5, at.y + 0.5};
        if (label_fits(&closeup->field, &place) &&
            put_label(closeup, at, 0, false, ink_of(collision, box), points, true, name_of(collision, box)))
            return true;
    }
    return false;
}

static bool put_labels(Closeup *closeup) {
    add_obstacles(closeup);
    return put_depths(closeup) && put_normal(closeup) && put_box_name(closeup, 0) && put_box_name(closeup, 1) &&
           put_edge_label(closeup, 0, "reference edge") && put_edge_label(closeup, 1, "incident edge") &&
           put_side_plane(closeup);
}

static double narrow_phase_between(double a, double b) { return (a + b) / 2; }

/* Both edges are in the window, which is `around` times as large. */
static void look_at_edges(Closeup *closeup, const View *window, double around) {
    const Manifold *manifold = &closeup->collision->manifold;
    const Vec2 middle = vec2_scale(0.5f, vec2_add(closeup->edges[0][0], closeup->edges[0][1]));
    View *view = &closeup->view;
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < 4; i++) {
        const Vec2 end = closeup->edges[i / 2][i % 2];
        low[0] = fmin(low[0], (double)end.x), high[0] = fmax(high[0], (double)end.x);
        low[1] = fmin(low[1], (double)end.y), high[1] = fmax(high[1], (double)end.y);
    }
    const double side = fmax(fmax(high[0] - low[0], high[1] - low[1]), (double)closeup->unit);
    *view = *window;
    view->center = (Point){narrow_phase_between(low[0], high[0]), narrow_phase_between(low[1], high[1])};
    view->scale = fmin(view->high.x - view->low.x, view->high.y - view->low.y) / (around * side);
    for (int i = 0; i < manifold->count; i++) {
        const ManifoldPoint *point = &manifold->points[i];
        closeup->on_face[i] = view_place(view, point->position);
        closeup->deep[i] = view_place(view, vec2_add(point->position, vec2_scale(point->separation, closeup->front)));
    }
    closeup->foot = view_place(view, middle);
    closeup->tip = view_place(view, vec2_add(middle, vec2_scale(0.33f * closeup->unit, closeup->front)));
}

static void draw_closeup_lines(const Closeup *closeup) {
    const Collision *collision = closeup->collision;
    const View *view = &closeup->view;
    const int reference = reference_of(collision);
    const Pen thick = pen_line(ink_of(collision, reference), 5, NULL), plane = pen_line(INK_SOFT, 1.6, "(6,6)");
    const Pen dashed = pen_line(ink_of(collision, 1 - reference), 4, "(9,4)"), depth = pen_line(ACCENT, 1.8, NULL);
    const Pen dot = pen_fill(ACCENT, 1, NO_COLOUR), face = {0xFFFFFF, 1, ACCENT, 1.6, NULL};
    for (int i = 0; i < 2; i++) {
        Vec2 ends[2];
        side_plane(ends, closeup->edges[0][i], closeup->front, closeup->unit);
        sketch_line(closeup->sketch, view_place(view, ends[0]), view_place(view, ends[1]), &plane);
    }
    for (int i = 0; i < 2; i++)
        sketch_line(closeup->sketch, view_place(view, closeup->edges[i][0]), view_place(view, closeup->edges[i][1]),
                    i == 0 ? &thick : &dashed);
    for (int i = 0; i < collision->manifold.count; i++) {
        sketch_line(closeup->sketch, closeup->on_face[i], closeup->deep[i], &depth);
        sketch_dot(closeup->sketch, closeup->deep[i], dot_radius, &dot);
        sketch_dot(closeup->sketch, closeup->on_face[i], ring, &face);
    }
    sketch_arrow(closeup->sketch, closeup->foot, closeup->tip, HEAD_AT_END, ACCENT, 3);
}

/* Below a picture: the scale and, unless NULL, an arrow that shows where down is, as the picture is rotated. Without a
   sketch, it only counts its rows; a scale of 0 stands for the longest bar. */
static int draw_foot(Sketch *sketch, const View *window, double scale, double points, const Vec2 *down) {
    const double longest = fmin(14, (window->high.x - window->low.x) / 5), line = line_height(points);
    const double reach = 0.6 * line, gap = number_gap(points);
    Flow flow = {.first = {window->low.x, window->low.y + 0.5 * line},
                 .width = window->high.x - window->low.x,
                 .points = points};
    Point at = flow_place(&flow, longest + gap + type_width("0.05 m", points), 1);
    if (sketch != NULL) sketch_scale_bar(sketch, at, scale, round_down(longest / scale), "m", points);
    if (down == NULL) return flow.row + 1;
    at = flow_place(&flow, 2 * reach + gap + type_width("down", points), 1);
    const Point tip = {reach * (double)down->x, reach * (double)down->y}, middle = {at.x + reach, at.y};
    if (sketch == NULL) return flow.row + 1;
    sketch_arrow(sketch, (Point){middle.x - tip.x, middle.y - tip.y}, (Point){middle.x + tip.x, middle.y + tip.y},
                 HEAD_AT_END, INK_SOFT, 2);
    sketch_text(sketch, (Point){middle.x + reach + gap, at.y}, &(TextStyle){points, TEXT_LEFT, INK_SOFT, 0, false},
                "down");
    return flow.row + 1;
}

/* The part of the window above the foot, which draw_foot() is told to begin at `foot`. */
static View above_foot(View *foot, View window, double points, const Vec2 *down) {
    const int rows = draw_foot(NULL, &window, 0, points, down);
    *foot = window;
    foot->low.y += (rows - 1) * line_height(points);
    window.low.y += (rows + 0.3) * line_height(points);
    return window;
}

/* Where labels have no room they are smaller, but not below this. */
#define LEAST_POINTS 4.0

bool draw_contact_closeup(Sketch *sketch, View window, const Collision *collision, Error *error) {
    static const double arounds[] = {1.27, 1.5, 1.8, 2.2, 2.7, 3.3, 4, 5}, sizes[] = {1, 0.85, 0.72, 0.62};
    enum { AROUNDS = sizeof arounds / sizeof *arounds, SIZES = sizeof sizes / sizeof *sizes };
    const double points = 0.94 * collision->points;
    Closeup *closeup = calloc(1, sizeof *closeup);
    bool placed = false;
    View foot;
    if (closeup == NULL) return error_memory(error, "figure");
    const int reference = reference_of(collision);
    const Vec2 normal = collision->manifold.normal;
    closeup->collision = collision;
    closeup->front = reference == 0 ? normal : vec2_negate(normal);
    find_edges(collision, closeup->front, closeup->edges);
    closeup->unit = unit_of((const Vec2(*)[2])closeup->edges);
    window = above_foot(&foot, window, points, NULL);
    for (int i = 0; i < AROUNDS * SIZES && !placed; i++) {
        closeup->points = fmax(sizes[i / AROUNDS] * collision->points, LEAST_POINTS);
        look_at_edges(closeup, &window, arounds[i % AROUNDS]);
        placed = put_labels(closeup);
    }
    if (placed) {
        closeup->sketch = sketch;
        draw_collision_boxes(sketch, &closeup->view, collision);
        draw_closeup_lines(closeup);
        put_labels(closeup);
        draw_foot(sketch, &foot, closeup->view.scale, points, NULL);
        sketch_rectangle(sketch, window.low, window.high, &(Pen){NO_COLOUR, 1, FRAME, 1.8, NULL});
    } else
        error_input(error, "figure", "the labels of the contact have no room in %.0f x %.0f mm at a font size of %g",
                    window.high.x - window.low.x, window.high.y - window.low.y, collision->points);
    free(closeup);
    return placed;
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

/* mm: from the boxes to their gauges; from a gauge's line to the outline of its overlap, and from there to the
   label. */
static const double far_gauge = 7, near_gauge = 3, outline = 4.1, label_gap = 0.8;

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
    double away = view->scale * reach + (overlap->box == 0 ? far_gauge : near_gauge);
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

/* A line of a label. */
typedef struct DepthLine {
    char text[DEPTH_TEXT_SIZE];
    Point at;
    TextStyle style;
} DepthLine;

/* Beside a vertical bar, along a horizontal one. Returns the number of lines. */
static int label_depth(DepthLine lines[2], const View *view, const Gauge *gauge, double place,
                       const Collision *collision, int i) {
    const bool beside = fabsf(gauge->out.x) > fabsf(gauge->out.y) && has_room_beside(view, collision);
    const double step = 1.05 * line_height(collision->points), em = depth_points(collision, i) * MM_PER_POINT;
    const double off = outline + label_gap + (beside ? 0 : 0.45 * em);
    TextStyle words = {depth_points(collision, i), TEXT_CENTER, INK, 0, true};
    if (beside) words.align = gauge->out.x > 0 ? TEXT_LEFT : TEXT_RIGHT;
    if (!beside) words.degrees = atan((double)(gauge->along.y / gauge->along.x)) * 180 / M_PI;
    if (words.degrees < -80) words.degrees += 180; /* all vertical labels read in the same direction */
    lines[0] = lines[1] = (DepthLine){.at = gauge_point(gauge, place, off), .style = words};
    format_depth(lines[0].text, collision, i);
    if (i != collision->least) return 1;
    snprintf(lines[1].text, sizeof lines[1].text, "%s", collision->label);
    lines[1].style.points = 0.94 * collision->points;
    lines[1].at = beside ? (Point){lines[0].at.x, lines[0].at.y - step} : gauge_point(gauge, place, off + step);
    return 2;
}

/* The ends of the overlap on an axis. */
static void overlap_ends(double ends[2], const AxisOverlap *overlap) {
    const int upper = overlap->high[0] - overlap->low[1] < overlap->high[1] - overlap->low[0] ? 0 : 1;
    ends[0] = overlap->low[1 - upper], ends[1] = overlap->high[upper];
}

static void draw_gauge(Sketch *sketch, const View *view, const Collision *collision, int i) {
    const AxisOverlap *overlap = &collision->overlaps[i];
    const Gauge gauge = place_gauge(view, collision, overlap);
    const bool least = i == collision->least;
    DepthLine lines[2];
    double ends[2];
    for (int k = 0; k < 2; k++) {
        const Pen pen = pen_fill(fill_of(collision, k), is_bomb(collision, k) ? 0.85 : 0.35, ink_of(collision, k));
        draw_bar(sketch, &gauge, overlap->low[k], overlap->high[k], 1.9 * k, &pen);
    }
    overlap_ends(ends, overlap);
    const Point corners[] = {gauge_point(&gauge, ends[0], -0.7), gauge_point(&gauge, ends[1], -0.7),
                             gauge_point(&gauge, ends[1], outline), gauge_point(&gauge, ends[0], outline)};
    const Pen mark = pen_line(ACCENT, least ? 5 : 1.8, NULL);
    sketch_shape(sketch, corners, 4, &mark);
    if (least) draw_guides(sketch, &gauge, ends);
    const int count = label_depth(lines, view, &gauge, (ends[0] + ends[1]) / 2, collision, i);
    for (int k = 0; k < count; k++) sketch_text(sketch, lines[k].at, &lines[k].style, "%s", lines[k].text);
}

/* What is drawn, as rectangles: the boxes, the gauges, and their labels. */
enum { QUADS_BEFORE_LABELS = 2 + SEPARATING_AXES, QUADS_MAX = QUADS_BEFORE_LABELS + 2 * SEPARATING_AXES };
typedef struct Quads {
    int count;
    Point corners[QUADS_MAX][4];
} Quads;

static void add_quad(Quads *quads, Point middle, Point x, Point y) {
    static const int signs[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (int i = 0; i < 4; i++)
        quads->corners[quads->count][i] =
            (Point){middle.x + signs[i][0] * x.x + signs[i][1] * y.x, middle.y + signs[i][0] * x.y + signs[i][1] * y.y};
    quads->count++;
}

static void add_line_of_text(Quads *quads, const DepthLine *line) {
    const double half = type_width(line->text, line->style.points) / 2, high = 0.5 * line->style.points * MM_PER_POINT;
    const double angle = line->style.degrees * M_PI / 180, c = cos(angle), s = sin(angle);
    const double shift = line->style.align == TEXT_CENTER ? 0 : line->style.align == TEXT_LEFT ? half : -half;
    add_quad(quads, (Point){line->at.x + shift, line->at.y}, (Point){half * c, half * s}, (Point){-high * s, high * c});
}

static void add_gauge(Quads *quads, const Gauge *gauge, double from, double to) {
    const Point middle = gauge_point(gauge, (from + to) / 2, (outline - 0.7) / 2);
    const double half = gauge->scale * (to - from) / 2, high = (outline + 0.7) / 2;
    add_quad(quads, middle, (Point){half * (double)gauge->along.x, half * (double)gauge->along.y},
             (Point){high * (double)gauge->out.x, high * (double)gauge->out.y});
}

static void gather_quads(Quads *quads, const View *view, const Collision *collision) {
    quads->count = 0;
    for (int i = 0; i < 2; i++) {
        const Box *box = &collision->boxes[i];
        const double x = (double)box->half.x * view->scale, y = (double)box->half.y * view->scale;
        const Vec2 along = box->rotation.column1;
        add_quad(quads, view_place(view, box->position), (Point){x * (double)along.x, x * (double)along.y},
                 (Point){-y * (double)along.y, y * (double)along.x});
    }
    for (int i = 0; i < SEPARATING_AXES; i++) {
        const AxisOverlap *overlap = &collision->overlaps[i];
        const Gauge gauge = place_gauge(view, collision, overlap);
        add_gauge(quads, &gauge, fmin(overlap->low[0], overlap->low[1]), fmax(overlap->high[0], overlap->high[1]));
    }
    for (int i = 0; i < SEPARATING_AXES; i++) {
        const AxisOverlap *overlap = &collision->overlaps[i];
        const Gauge gauge = place_gauge(view, collision, overlap);
        DepthLine lines[2];
        double ends[2];
        overlap_ends(ends, overlap);
        const int count = label_depth(lines, view, &gauge, (ends[0] + ends[1]) / 2, collision, i);
        for (int k = 0; k < count; k++) add_line_of_text(quads, &lines[k]);
    }
}

/* The separating axis theorem again: along the sides of both. */
static bool quads_meet(const Point a[4], const Point b[4]) {
    for (int side = 0; side < 4; side++) {
        const Point *of = side < 2 ? a : b;
        const Point axis = {of[1 + side % 2].x - of[side % 2].x, of[1 + side % 2].y - of[side % 2].y};
        double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
        for (int i = 0; i < 8; i++) {
            const Point p = i < 4 ? a[i] : b[i - 4];
            const double at = p.x * axis.x + p.y * axis.y;
            low[i / 4] = fmin(low[i / 4], at), high[i / 4] = fmax(high[i / 4], at);
        }
        if (high[0] <= low[1] || high[1] <= low[0]) return false;
    }
    return true;
}

/* Moves the view so that all is in the middle of its window. False if there is no room, or if a label meets
   anything. */
static bool centre_overlaps(View *view, const Collision *collision) {
    Quads quads;
    Point low = {HUGE_VAL, HUGE_VAL}, high = {-HUGE_VAL, -HUGE_VAL};
    gather_quads(&quads, view, collision);
    for (int i = 0; i < quads.count; i++)
        for (int k = 0; k < 4; k++) {
            low.x = fmin(low.x, quads.corners[i][k].x), high.x = fmax(high.x, quads.corners[i][k].x);
            low.y = fmin(low.y, quads.corners[i][k].y), high.y = fmax(high.y, quads.corners[i][k].y);
        }
    for (int i = QUADS_BEFORE_LABELS; i < quads.count; i++)
        for (int k = 0; k < i; k++)
            if (quads_meet(quads.corners[i], quads.corners[k])) return false;
    view->center.x += ((low.x + high.x) - (view->low.x + view->high.x)) / 2 / view->scale;
    view->center.y += ((low.y + high.y) - (view->low.y + view->high.y)) / 2 / view->scale;
    return high.x - low.x <= view->high.x - view->low.x && high.y - low.y <= view->high.y - view->low.y;
}

/* The largest scale at which all has room. */
static bool look_at_overlaps(View *view, const Collision *collision, Error *error) {
    const double least = 2; /* mm: a side of the boxes together */
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (int i = 0; i < 2; i++) {
        const Box *box = &collision->boxes[i];
        const Vec2 x = vec2_scale(box->half.x, box->rotation.column1),
                   y = vec2_scale(box->half.y, box->rotation.column2);
        const double reach[2] = {fabs((double)x.x) + fabs((double)y.x), fabs((double)x.y) + fabs((double)y.y)};
        const double at[2] = {(double)box->position.x, (double)box->position.y};
        for (int k = 0; k < 2; k++) low[k] = fmin(low[k], at[k] - reach[k]), high[k] = fmax(high[k], at[k] + reach[k]);
    }
    const double side = fmax(high[0] - low[0], high[1] - low[1]);
    const double width = view->high.x - view->low.x, height = view->high.y - view->low.y;
    for (double scale = fmin(width, height) / side; scale * side > least; scale *= 0.97) {
        view->scale = scale;
        view->center = (Point){(low[0] + high[0]) / 2, (low[1] + high[1]) / 2};
        if (centre_overlaps(view, collision)) return true;
    }
    return error_input(error, "figure",
                       "the overlaps and their labels have no room in %.0f x %.0f mm at a font size of %g", width,
                       height, collision->points);
}

bool draw_overlaps(Sketch *sketch, View window, const Collision *collision, const Vec2 *down, Error *error) {
    const double points = 0.94 * collision->points;
    View foot, view = above_foot(&foot, window, points, down);
    Collision smaller = *collision;
    while (!look_at_overlaps(&view, &smaller, error)) {
        if (smaller.points < 1.1 * LEAST_POINTS || error->kind != ERROR_INPUT) return false;
        smaller.points *= 0.9;
        *error = (Error){0};
    }
    collision = &smaller;
    draw_collision_boxes(sketch, &view, collision);
    for (int i = 0; i < SEPARATING_AXES; i++) draw_gauge(sketch, &view, collision, i);
    for (int i = 0; i < 2; i++) {
        const Point at = view_place(&view, collision->boxes[i].position);
        const double side = 1.8 * view.scale * (double)fminf(collision->boxes[i].half.x, collision->boxes[i].half.y);
        const TextStyle words = {text_points(name_of(collision, i), 1.06 * collision->points, side), TEXT_CENTER,
                                 ink_of(collision, i), 0, false};
        if (words.points < LEAST_POINTS) continue; /* the close-up names the boxes, too */
        sketch_text(sketch, at, &words, "%s", name_of(collision, i));
    }
    draw_foot(sketch, &foot, view.scale, points, down);
    return true;
}
