/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Places of labels: the nearest that covers no box and crosses no line, and lines from there to the mark. */
#include "figures/labels.h"

#include "base/base.h"
#include "figures/sketch.h"

#include <math.h>

void label_add_box(LabelField *field, PageBox box) {
    if (field->box_count < LABEL_MAX_BOXES) field->boxes[field->box_count++] = box;
}

void label_add_segment(LabelField *field, Segment segment) {
    if (field->segment_count < LABEL_MAX_SEGMENTS) field->segments[field->segment_count++] = segment;
}

/* Clips [*from, *to], the range of t for which p + t d is in [low, high], along one axis. */
static void clip(double p, double d, double low, double high, double *from, double *to) {
    if (d == 0) {
        if (p < low || p > high) *to = -1;
        return;
    }
    double a = (low - p) / d, b = (high - p) / d;
    *from = fmax(*from, fmin(a, b));
    *to = fmin(*to, fmax(a, b));
}

/* Liang and Barsky 1984. */
static bool crosses(const Segment *s, const PageBox *box) {
    double from = 0, to = 1;
    clip(s->x0, s->x1 - s->x0, box->left, box->right, &from, &to);
    clip(s->y0, s->y1 - s->y0, box->bottom, box->top, &from, &to);
    return from < to;
}

static bool is_free(const LabelField *field, const PageBox *box) {
    const PageBox *frame = &field->frame;
    if (box->left < frame->left || box->right > frame->right || box->bottom < frame->bottom || box->top > frame->top)
        return false;
    for (int i = 0; i < field->box_count; i++) {
        const PageBox *other = &field->boxes[i];
        if (box->left < other->right && other->left < box->right && box->bottom < other->top &&
            other->bottom < box->top)
            return false;
    }
    return true;
}

/* mm, for the width of lines. */
static const double clearance = 0.35;

static int crossed(const LabelField *field, const PageBox *box) {
    int count = 0;
    PageBox wide = {box->left - clearance, box->bottom - clearance, box->right + clearance, box->top + clearance};
    for (int i = 0; i < field->segment_count; i++) count += crosses(&field->segments[i], &wide);
    return count;
}

bool label_place(LabelField *field, double x, double y, double distance, double width, double height, bool must,
                 PageBox *place) {
    /* Right, left, above, below, then the corners. -1, 0, 1: the side of the mark. */
    static const struct { int x, y; } sides[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    /* A label farther away would seem to belong to another mark. */
    double farthest = must ? 6 * distance : 1.5 * distance;
    int fewest = -1;
    for (double d = distance; d <= farthest; d += 0.25 * distance)
        for (int side = 0; side < (int)(sizeof sides / sizeof *sides); side++) {
            /* Diagonally, both offsets contribute. */
            const double reach = sides[side].x != 0 && sides[side].y != 0 ? 0.6 * d : d;
            const double at_x = x + sides[side].x * (reach + width / 2),
                         at_y = y + sides[side].y * (reach + height / 2);
            const PageBox box = {at_x - width / 2, at_y - height / 2, at_x + width / 2, at_y + height / 2};
            if (!is_free(field, &box)) continue;
            int count = crossed(field, &box);
            if ((count > 0 && !must) || (fewest >= 0 && count >= fewest)) continue;
            fewest = count;
            *place = box;
        }
    if (fewest >= 0) label_add_box(field, *place);
    return fewest >= 0;
}

static double turn(double ax, double ay, double bx, double by, double cx, double cy) {
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
}

static double distance_to(const Segment *line, double x, double y) {
    const double dx = line->x1 - line->x0, dy = line->y1 - line->y0, square = dx * dx + dy * dy;
    const double share = square > 0 ? fmin(fmax(((x - line->x0) * dx + (y - line->y0) * dy) / square, 0), 1) : 0;
    return hypot(x - line->x0 - share * dx, y - line->y0 - share * dy);
}

/* The mark's own box contains the start of its leader. */
static bool line_is_free(const LabelField *field, const Segment *line, const LabelWish *wish) {
    const double reach = hypot(line->x1 - wish->x, line->y1 - wish->y);
    const Segment *a = line;
    for (int i = 0; i < field->segment_count && !wish->across; i++) {
        const Segment *b = &field->segments[i];
        const bool cross =
            turn(a->x0, a->y0, a->x1, a->y1, b->x0, b->y0) * turn(a->x0, a->y0, a->x1, a->y1, b->x1, b->y1) < 0 &&
            turn(b->x0, b->y0, b->x1, b->y1, a->x0, a->y0) * turn(b->x0, b->y0, b->x1, b->y1, a->x1, a->y1) < 0;
        /* Or ending on it: a line along another would hide it. */
        if (cross || distance_to(a, b->x0, b->y0) < clearance || distance_to(a, b->x1, b->y1) < clearance) return false;
    }
    for (int i = wish->across ? field->crossable : 0; i < field->box_count; i++) {
        const PageBox *box = &field->boxes[i];
        const bool own = wish->x >= box->left && wish->x <= box->right && wish->y >= box->bottom && wish->y <= box->top;
        if (!own && reach > 0 && crosses(line, box)) return false;
    }
    return true;
}

/* Beside its label, a mark leads to the lower corner and along below: a line that ended at the middle of a number would
   be read as its minus sign. */
static bool has_shelf(double from_y, const PageBox *box) { return from_y > box->bottom && from_y < box->top; }

bool label_place_led(LabelField *field, const LabelWish *wish, PageBox *place, Segment *leader, bool *led) {
    /* From one side to the other around the mark: 16 directions, the sides first. */
    static const int order[] = {0, 1, 15, 2, 14, 3, 13, 4, 12, 5, 11, 6, 10, 7, 9, 8};
    const double step = 0.6, shortest = 0.9, gap = 0.4, width = wish->width, height = wish->height;
    for (double distance = fmax(wish->clear + gap, wish->nearest); distance <= wish->farthest; distance += step)
        for (int direction = 0; direction < 16; direction++) {
            const double turned = order[direction] * M_PI / 8, angle = wish->left ? M_PI - turned : turned;
            const double middle_x = wish->x + distance * cos(angle) + width / 2 * cos(angle);
            const double middle_y = wish->y + distance * sin(angle) + height / 2 * sin(angle);
            *place =
                (PageBox){middle_x - width / 2, middle_y - height / 2, middle_x + width / 2, middle_y + height / 2};
            /* To the nearest point of the label, or to its corner. */
            const double x = fmin(fmax(wish->x, place->left), place->right);
            const double y = fmin(fmax(wish->y, place->bottom), place->top);
            const double end = wish->shelf && has_shelf(wish->y, place) && x != wish->x ? place->bottom : y;
            const double length = hypot(x - wish->x, end - wish->y),
                         share = length > 0 ? fmin(1, wish->clear / length) : 1;
            *leader = (Segment){wish->x + share * (x - wish->x), wish->y + share * (end - wish->y), x, end};
            if (!is_free(field, place) || crossed(field, place) > 0 || !line_is_free(field, leader, wish)) continue;
            *led = hypot(x - wish->x, y - wish->y) - wish->clear > shortest;
            label_add_box(field, *place);
            if (*led) {
                label_add_segment(field, *leader);
                if (wish->shelf && has_shelf(leader->y0, place))
                    label_add_segment(field, (Segment){place->left, leader->y1, place->right, leader->y1});
            }
            return true;
        }
    return false;
}

void draw_leader(Sketch *sketch, const Segment *leader, const PageBox *label, const Pen *pen) {
    const double far = leader->x1 == label->left ? label->right : label->left;
    const Point points[] = {{leader->x0, leader->y0}, {leader->x1, leader->y1}, {far, leader->y1}};
    sketch_path(sketch, points, has_shelf(leader->y0, label) ? 3 : 2, pen);
}
