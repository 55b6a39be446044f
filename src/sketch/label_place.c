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
