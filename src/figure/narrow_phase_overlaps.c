/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "figure/narrow_phase.h"
#include "type/type.h"

#include <math.h>
#include <stdio.h>

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
static View look_at(View view, const Collision *collision) {
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
    const View view = look_at(window, collision);
    draw_collision_boxes(sketch, &view, collision);
    for (int i = 0; i < SEPARATING_AXES; i++) draw_gauge(sketch, &view, collision, i);
    for (int i = 0; i < 2; i++) {
        const TextStyle words = {1.06 * collision->points, TEXT_CENTER, ink_of(collision, i), 0, false};
        sketch_text(sketch, view_place(&view, collision->boxes[i].position), &words, "%s", name_of(collision, i));
    }
    sketch_scale_bar(sketch, (Point){view.low.x + 3, view.low.y + 5}, view.scale, round_down(14 / view.scale), "m",
                     0.94 * collision->points);
}
