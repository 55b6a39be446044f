/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Figure 2: a collision of the bomb from the pyramid's run, at true scale: left the overlaps along the four axes, right
   the contact points that come of the least. */
#include "figure/engine_figure.h"
#include "figure/engine_run.h"
#include "figure/separating_axes.h"

#include "dynamics/pair.h"
#include "render/style.h"

#include <math.h>

#define LEAST_TILT 10.0 /* degrees: below, two axes of one box can hardly be told from the other's */

#define MINUS "\xe2\x88\x92" /* as wide as a plus */

static const double width = 174, height = 88; /* mm */

typedef struct Collision {
    Box boxes[2];
    int bodies[2], bomb, step;
    Manifold manifold;
    AxisOverlap overlaps[SEPARATING_AXES];
    int least;
} Collision;

static const uint32_t inks[2] = {BOX_INK, 0x5E1606};

/* Of the box, or of the bomb. */
static uint32_t fill_of(const Collision *collision, int i) {
    return collision->bodies[i] == collision->bomb ? BOMB.fill : BOX_COLOUR;
}

static uint32_t ink_of(const Collision *collision, int i) { return inks[collision->bodies[i] == collision->bomb]; }

static const char *name_of(const Collision *collision, int i) {
    return collision->bodies[i] == collision->bomb ? "bomb" : "box";
}

/* Degrees between the sides of two boxes. */
static double tilt(const ProblemBody *a, const ProblemBody *b) {
    double turned = fmod(fabs((double)b->angle - (double)a->angle) * 180 / M_PI, 90);
    return fmin(turned, 90 - turned);
}

/* The bomb against a box that can move, turned against each other and with two points: what the text describes shows. */
static bool shows_all(const ContactProblem *problem, int first) {
    int a = problem->contacts[first].a, b = problem->contacts[first].b;
    const ProblemBody *body_a = &problem->bodies[a], *body_b = &problem->bodies[b];
    return (a == problem->bomb || b == problem->bomb) && body_a->inv_mass > 0 && body_b->inv_mass > 0 &&
           pair_contact_count(problem, first) == 2 && tilt(body_a, body_b) >= LEAST_TILT;
}

static bool find_in_step(Collision *collision, const EngineRun *run) {
    const ContactProblem *problem = world_problem(run->world);
    for (int i = next_pair(problem, -1); i < problem->contact_count; i = next_pair(problem, i)) {
        if (!shows_all(problem, i)) continue;
        int a = problem->contacts[i].a, b = problem->contacts[i].b;
        *collision = (Collision){.boxes = {engine_run_box(run, a), engine_run_box(run, b)},
                                 .bodies = {a, b},
                                 .bomb = problem->bomb,
                                 .step = run->frame};
        manifold_compute(&collision->manifold, &collision->boxes[0], &collision->boxes[1]);
        separating_axes(collision->overlaps, &collision->boxes[0], &collision->boxes[1]);
        collision->least = least_overlap(collision->overlaps);
        return true;
    }
    return false;
}

static bool find_collision(Collision *collision, const Scene *scene, Error *error) {
    EngineRun run;
    if (!engine_run_begin(&run, scene, error)) return false;
    bool ok = true, found = false;
    while (ok && !found && run.frame < scene->frames) {
        ok = engine_run_step(&run, error);
        found = ok && find_in_step(collision, &run);
    }
    engine_run_end(&run);
    if (ok && !found)
        return error_input(error, scene->name, "the bomb touches no box in two points at %g degrees or more",
                           LEAST_TILT);
    return ok;
}

static void put_boxes(Sketch *sketch, const View *view, const Collision *collision) {
    for (int i = 0; i < 2; i++) {
        const Pen pen = pen_fill(fill_of(collision, i), 0.16, ink_of(collision, i));
        sketch_box(sketch, view, &collision->boxes[i], &pen);
    }
}

/* Where the shadows on one axis are drawn: a point of the page for each place along it. */
typedef struct Gauge {
    Point from; /* place 0, on the line nearer to the boxes */
    Vec2 along, out;
    double scale;
} Gauge;

static Point gauge_point(const Gauge *gauge, double place, double off) {
    double x = (double)gauge->along.x, y = (double)gauge->along.y;
    return (Point){gauge->from.x + place * gauge->scale * x + off * (double)gauge->out.x,
                   gauge->from.y + place * gauge->scale * y + off * (double)gauge->out.y};
}

static void put_bar(Sketch *sketch, const Gauge *gauge, double low, double high, double off, const Pen *pen) {
    const double thick = 1.5;
    const Point corners[] = {gauge_point(gauge, low, off), gauge_point(gauge, high, off),
                             gauge_point(gauge, high, off + thick), gauge_point(gauge, low, off + thick)};
    sketch_shape(sketch, corners, 4, pen);
}

/* The gauge of an axis lies beyond the boxes, on the side of the box that has the axis. */
static Gauge place_gauge(const View *view, const Collision *collision, const AxisOverlap *overlap) {
    Vec2 out = vec2_cross_scalar(overlap->axis, 1);
    Vec2 own = collision->boxes[overlap->box].position, other = collision->boxes[1 - overlap->box].position;
    /* Across the pair its own box tells the side; along the pair there is room on either. */
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
    double away = view->scale * reach + 3;
    return (Gauge){{origin.x + away * (double)out.x, origin.y + away * (double)out.y}, overlap->axis, out, view->scale};
}

/* Lines from the ends of the least overlap to where the boxes overlap. */
static void put_guides(Sketch *sketch, const Gauge *gauge, const double ends[2]) {
    const Pen pen = pen_line(INK_SOFT, 1.2, "(4,4)");
    for (int i = 0; i < 2; i++)
        sketch_line(sketch, gauge_point(gauge, ends[i], 0), gauge_point(gauge, ends[i], -1.1 * gauge->scale), &pen);
}

static void put_gauge(Sketch *sketch, const View *view, const Collision *collision, int i) {
    const AxisOverlap *overlap = &collision->overlaps[i];
    const Gauge gauge = place_gauge(view, collision, overlap);
    bool least = i == collision->least;
    for (int k = 0; k < 2; k++) {
        const Pen pen = pen_fill(fill_of(collision, k), 0.55, ink_of(collision, k));
        put_bar(sketch, &gauge, overlap->low[k], overlap->high[k], 1.9 * k, &pen);
    }
    int upper = overlap->high[0] - overlap->low[1] < overlap->high[1] - overlap->low[0] ? 0 : 1;
    const double ends[2] = {overlap->low[1 - upper], overlap->high[upper]};
    const Point corners[] = {gauge_point(&gauge, ends[0], -0.7), gauge_point(&gauge, ends[1], -0.7),
                             gauge_point(&gauge, ends[1], 4.1), gauge_point(&gauge, ends[0], 4.1)};
    const Pen mark = {least ? ACCENT : NO_COLOUR, 1, ACCENT, 1.8, NULL};
    sketch_shape(sketch, corners, 4, &mark);
    if (least) put_guides(sketch, &gauge, ends);
    Point at = gauge_point(&gauge, (ends[0] + ends[1]) / 2, 6);
    bool beside = fabsf(gauge.out.x) > fabsf(gauge.out.y);
    TextStyle words = {least ? 9 : 7.5, TEXT_CENTER, INK, 0};
    if (beside) words.align = gauge.out.x > 0 ? TEXT_LEFT : TEXT_RIGHT;
    if (!beside) at.y += gauge.out.y > 0 ? 1 : -1;
    sketch_text(sketch, at, &words, "%s %c: %.0f mm", name_of(collision, overlap->box), overlap->letter,
                1000 * overlap->depth);
    at.y -= 3.8;
    words.points = 7.5;
    if (least) sketch_text(sketch, at, &words, "the least");
}

static Point middle_of(const Collision *collision) {
    Vec2 sum = vec2_add(collision->boxes[0].position, collision->boxes[1].position);
    return (Point){(double)sum.x / 2, (double)sum.y / 2};
}

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
    const TextStyle style = {7.5, TEXT_CENTER, colour, atan2(q.y - p.y, q.x - p.x) * 180 / M_PI};
    const Point at = {p.x + share * (q.x - p.x) + 2.4 * (double)off.x, p.y + share * (q.y - p.y) + 2.4 * (double)off.y};
    sketch_text(sketch, at, &style, "%s", words);
}

static void put_edges(Sketch *sketch, const View *view, const Collision *collision, Vec2 front) {
    Vec2 ends[2];
    int reference = reference_of(collision);
    uint32_t ink = ink_of(collision, reference), other_ink = ink_of(collision, 1 - reference);
    facing_edge(ends, &collision->boxes[reference], front);
    const Pen plane = pen_line(INK_SOFT, 1.6, "(6,6)");
    for (int i = 0; i < 2; i++)
        sketch_line(sketch, view_place(view, vec2_add(ends[i], vec2_scale(-0.3f, front))),
                    view_place(view, vec2_add(ends[i], vec2_scale(0.25f, front))), &plane);
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
        const TextStyle words = {8.5, left ? TEXT_LEFT : TEXT_RIGHT, ACCENT, 0};
        sketch_text(sketch, (Point){deep.x + (left ? -1 : 1), deep.y - 4}, &words, MINUS "%.0f mm",
                    -1000 * (double)point->separation);
    }
}

static void put_overlaps(Sketch *sketch, const Collision *collision) {
    const View view = {{4, 0}, {width / 2 + 4, height - 6}, middle_of(collision), 23};
    put_boxes(sketch, &view, collision);
    for (int i = 0; i < SEPARATING_AXES; i++) put_gauge(sketch, &view, collision, i);
    for (int i = 0; i < 2; i++) {
        const TextStyle words = {8.5, TEXT_CENTER, ink_of(collision, i), 0};
        sketch_text(sketch, view_place(&view, collision->boxes[i].position), &words, "%s", name_of(collision, i));
    }
    sketch_scale_bar(sketch, (Point){4, 5}, 0.5, &view);
}

static void put_contact(Sketch *sketch, const Collision *collision) {
    const Manifold *manifold = &collision->manifold;
    int reference = reference_of(collision);
    Vec2 front = reference == 0 ? manifold->normal : vec2_negate(manifold->normal), ends[2];
    facing_edge(ends, &collision->boxes[reference], front);
    Vec2 middle = vec2_scale(0.5f, vec2_add(ends[0], ends[1]));
    const View view = {{width / 2 + 5, 1}, {width - 1, height - 7}, {(double)middle.x, (double)middle.y}, 60};
    put_boxes(sketch, &view, collision);
    put_edges(sketch, &view, collision, front);
    put_points(sketch, &view, collision, front);
    Point from = view_place(&view, middle), to = view_place(&view, vec2_add(middle, vec2_scale(0.35f, front)));
    sketch_arrow(sketch, from, to, HEAD_AT_END, ACCENT, 3);
    const TextStyle words = {8.5, TEXT_CENTER, ACCENT, 0};
    sketch_text(sketch, (Point){to.x, to.y + 3}, &words, "normal (%.3f, %.3f)", (double)manifold->normal.x,
                (double)manifold->normal.y);
    sketch_scale_bar(sketch, (Point){view.low.x + 4, view.low.y + 4}, 0.2, &view);
    sketch_rectangle(sketch, view.low, view.high, &(Pen){NO_COLOUR, 1, FRAME, 1.8, NULL});
}

static bool draw(Sketch *sketch, Scene *const scenes[FIGURE_SCENES], char caption[CAPTION_SIZE], Error *error) {
    Collision collision;
    if (!find_collision(&collision, scenes[SCENE_PYRAMID], error)) return false;
    put_overlaps(sketch, &collision);
    put_contact(sketch, &collision);
    const TextStyle title = {8.5, TEXT_LEFT, INK, 0};
    sketch_text(sketch, (Point){1, height - 2.5}, &title, "Overlap along each box's two axes");
    sketch_text(sketch, (Point){width / 2 + 5, height - 2.5}, &title, "Contact points along the axis of the least");
    const AxisOverlap *o = collision.overlaps;
    const ManifoldPoint *points = collision.manifold.points;
    snprintf(
        caption, CAPTION_SIZE,
        "The narrow phase for bodies %d and %d in step %d of pyramid.yaml, at true scale: the boxes overlap by %.0f "
        "and "
        "%.0f mm along the axes of the %s and by %.0f and %.0f mm along those of the %s. The least, %.0f mm, gives the "
        "normal (%.3f, %.3f), and the incident edge, clipped to the sides of the reference edge, two contact points, "
        "%.0f and %.0f mm deep.",
        collision.bodies[0], collision.bodies[1], collision.step, 1000 * o[0].depth, 1000 * o[1].depth,
        name_of(&collision, 0), 1000 * o[2].depth, 1000 * o[3].depth, name_of(&collision, 1),
        1000 * o[collision.least].depth, (double)collision.manifold.normal.x, (double)collision.manifold.normal.y,
        -1000 * (double)points[0].separation, -1000 * (double)points[1].separation);
    return true;
}

const EngineFigure figure_narrow_phase = {width, height, draw};
