/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sketch/label_place.h"

#include <math.h>

void label_add_box(LabelField *field, PageBox box) {
    if (field->box_count < LABEL_MAX_BOXES) field->boxes[field->box_count++] = box;
}

void label_add_segment(LabelField *field, Segment segment) {
    if (field->segment_count < LABEL_MAX_SEGMENTS) field->segments[field->segment_count++] = segment;
}

static bool boxes_touch(const PageBox *a, const PageBox *b) {
    return a->left < b->right && b->left < a->right && a->bottom < b->top && b->bottom < a->top;
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
    for (int i = 0; i < field->box_count; i++)
        if (boxes_touch(box, &field->boxes[i])) return false;
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

/* Right, left, above, below, then the corners. -1, 0, 1: the side of the mark. */
static const struct { int x, y; } sides[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};

static PageBox box_beside(double x, double y, int side, double distance, double width, double height) {
    /* Diagonally, both offsets contribute. */
    double reach = sides[side].x != 0 && sides[side].y != 0 ? 0.6 * distance : distance;
    double centre_x = x + sides[side].x * (reach + width / 2), centre_y = y + sides[side].y * (reach + height / 2);
    return (PageBox){centre_x - width / 2, centre_y - height / 2, centre_x + width / 2, centre_y + height / 2};
}

bool label_place(LabelField *field, double x, double y, double distance, double width, double height, bool must,
                 PageBox *place) {
    /* A label farther away would seem to belong to another mark. */
    double farthest = must ? 6 * distance : 1.5 * distance;
    int fewest = -1;
    for (double d = distance; d <= farthest; d += 0.25 * distance)
        for (int side = 0; side < (int)(sizeof sides / sizeof *sides); side++) {
            PageBox box = box_beside(x, y, side, d, width, height);
            if (!is_free(field, &box)) continue;
            int count = crossed(field, &box);
            if ((count > 0 && !must) || (fewest >= 0 && count >= fewest)) continue;
            fewest = count;
            *place = box;
        }
    if (fewest >= 0) label_add_box(field, *place);
    return fewest >= 0;
}

/* From one side to the other around the mark: 16 directions, the sides first. */
static double angle_of(int direction, bool left) {
    static const int order[] = {0, 1, 15, 2, 14, 3, 13, 4, 12, 5, 11, 6, 10, 7, 9, 8};
    const double angle = order[direction] * M_PI / 8;
    return left ? M_PI - angle : angle;
}

static double turn(double ax, double ay, double bx, double by, double cx, double cy) {
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
}

static bool segments_cross(const Segment *a, const Segment *b) {
    return turn(a->x0, a->y0, a->x1, a->y1, b->x0, b->y0) * turn(a->x0, a->y0, a->x1, a->y1, b->x1, b->y1) < 0 &&
           turn(b->x0, b->y0, b->x1, b->y1, a->x0, a->y0) * turn(b->x0, b->y0, b->x1, b->y1, a->x1, a->y1) < 0;
}

static double distance_to(const Segment *line, double x, double y) {
    const double dx = line->x1 - line->x0, dy = line->y1 - line->y0, square = dx * dx + dy * dy;
    const double share = square > 0 ? fmin(fmax(((x - line->x0) * dx + (y - line->y0) * dy) / square, 0), 1) : 0;
    return hypot(x - line->x0 - share * dx, y - line->y0 - share * dy);
}

/* Crossing, or ending on it: a line along another would hide it. */
static bool segments_meet(const Segment *a, const Segment *b) {
    return segments_cross(a, b) || distance_to(a, b->x0, b->y0) < clearance || distance_to(a, b->x1, b->y1) < clearance;
}

/* The mark's own box contains the start of its leader. */
static bool line_is_free(const LabelField *field, const Segment *line, const LabelWish *wish) {
    const double reach = hypot(line->x1 - wish->x, line->y1 - wish->y);
    for (int i = 0; i < field->segment_count; i++)
        if (segments_meet(line, &field->segments[i])) return false;
    for (int i = 0; i < field->box_count; i++) {
        const PageBox *box = &field->boxes[i];
        const bool own = wish->x >= box->left && wish->x <= box->right && wish->y >= box->bottom && wish->y <= box->top;
        if (!own && reach > 0 && crosses(line, box)) return false;
    }
    return true;
}

static PageBox box_towards(const LabelWish *wish, double angle, double distance) {
    const double x = wish->x + distance * cos(angle) + wish->width / 2 * cos(angle);
    const double y = wish->y + distance * sin(angle) + wish->height / 2 * sin(angle);
    return (PageBox){x - wish->width / 2, y - wish->height / 2, x + wish->width / 2, y + wish->height / 2};
}

static Segment leader_to(const LabelWish *wish, const PageBox *box) {
    const double x = fmin(fmax(wish->x, box->left), box->right), y = fmin(fmax(wish->y, box->bottom), box->top);
    const double length = hypot(x - wish->x, y - wish->y), share = length > 0 ? fmin(1, wish->clear / length) : 1;
    return (Segment){wish->x + share * (x - wish->x), wish->y + share * (y - wish->y), x, y};
}

bool label_place_led(LabelField *field, const LabelWish *wish, PageBox *place, Segment *leader, bool *led) {
    const double step = 0.6, shortest = 0.9, gap = 0.4;
    for (double distance = fmax(wish->clear + gap, wish->nearest); distance <= wish->farthest; distance += step)
        for (int direction = 0; direction < 16; direction++) {
            *place = box_towards(wish, angle_of(direction, wish->left), distance);
            *leader = leader_to(wish, place);
            if (!is_free(field, place) || crossed(field, place) > 0 || !line_is_free(field, leader, wish)) continue;
            *led = hypot(leader->x1 - leader->x0, leader->y1 - leader->y0) > shortest;
            label_add_box(field, *place);
            if (*led) label_add_segment(field, *leader);
            return true;
        }
    return false;
}
