/* SPDX-License-Identifier: GPL-3.0-or-later */
/* With friction the central path may turn back: its target rises for a while before it falls again, and Newton's method
   ends at the fold. So the path is followed by its length, with the target as one more unknown. At a fold the
   determinant changes its sign, which tells in what direction to continue. Lengths are measured in the logarithms of
   the point, which is natural inside of bounds. Source: Allgower, Georg, "Numerical Continuation Methods" (1990):
   Euler-Newton with orientation by the determinant. */
#pragma once
#include "network/activation.h"
#include "reference/reference_point.h"

enum { CORRECTIONS = 3, CORRECTIONS_FIRST = 20, GOOD_STEPS = 3 };

static const double arc_share = 0.9;                          /* of the way to the nearest bound that a step may go */
static const double near_path = 0.5, nearer = 0.25, lost = 3; /* distances from the path, in its length */
static const double length_first = 0.5, length_most = 8, length_least = 1e-5;

static const double target_end = 1e-10; /* (m/s)^2 */

typedef struct Tracker {
    Reference *r;
    double target; /* (m/s)^2 */
    double length; /* of the next step along the path */
    double near, off_before;
    int corrections, good;
    bool found; /* has been on the path */
} Tracker;

/* Product of two directions, per bound. */
static double product(const Reference *r, bool with_itself) {
    Vec4 sum = reference_all(0);
    for (int i = 0; i < r->group_count; i++) {
        const ReferencePoint *now = &r->groups[i].now, *x = &r->groups[i].step;
        const ReferencePoint *y = with_itself ? x : &r->groups[i].along;
        const Vec4 normal = x->l * y->l / (now->l * now->l) + x->z * y->z / (now->z * now->z);
        const Vec4 up = x->u * y->u / (now->u * now->u) + x->p * y->p / (now->p * now->p);
        sum += normal + up + x->w * y->w / (now->w * now->w) + x->q * y->q / (now->q * now->q);
    }
    return reference_sum(sum) / (3 * r->contact_count);
}

static ReferencePoint combine(const ReferencePoint *x, double share, const ReferencePoint *y) {
    return (ReferencePoint){x->l + share * y->l, x->t + share * y->t, x->u + share * y->u, x->w + share * y->w,
                            x->z + share * y->z, x->p + share * y->p, x->q + share * y->q};
}

/* Newton's step at the present target into `along`, and the derivative by the logarithm of the target into `step`.
   Returns the square of the former's length. */
static double find_directions(Reference *r, double target) {
    const size_t bodies = (size_t)r->lu.count;
    begin_step(r, target);
    end_step(r);
    const double squared = product(r, true);
    for (int i = 0; i < r->group_count; i++) r->groups[i].along = r->groups[i].step;
    memcpy(r->first_changes, r->changes, bodies * sizeof *r->changes);
    begin_next_step(r, 2 * target, 0); /* linear in the target */
    end_step(r);
    for (int i = 0; i < r->group_count; i++) r->groups[i].step = combine(&r->groups[i].step, -1, &r->groups[i].along);
    for (size_t k = 0; k < bodies; k++) r->changes[k] -= r->first_changes[k];
    return squared;
}

/* Back to the last point on the path, for shorter steps. */
static void go_back(Tracker *tracker) {
    tracker->target = return_to(tracker->r, KEPT_ON_PATH);
    tracker->length *= 0.25;
    tracker->corrections = 0;
    tracker->off_before = INFINITY;
}

/* The target after its logarithm has changed; NaN after a change that only a lost path makes. */
static double grown(double target, double by) { return fabs(by) <= 700 ? target * exponential(by) : NAN; }

/* Newton's step plus `by` times the derivative. Returns the share of it that the bounds allow. */
static double advance(Tracker *tracker, double by) {
    Reference *r = tracker->r;
    for (int i = 0; i < r->group_count; i++) r->groups[i].step = combine(&r->groups[i].along, by, &r->groups[i].step);
    for (int k = 0; k < r->lu.count; k++) r->changes[k] = r->first_changes[k] + by * r->changes[k];
    const double limit = arc_share * step_room(r), share = limit < 1 ? limit : 1;
    move(r, share);
    tracker->target = grown(tracker->target, share * by);
    return share;
}

static void choose_length(Tracker *tracker, double share, double off) {
    if (share >= 1 && off < 0.3)
        tracker->length = 2 * tracker->length < length_most ? 2 * tracker->length : length_most;
    else if (share < 0.7)
        tracker->length *= 0.5;
}

static bool is_lost(Tracker *tracker, double off) {
    const bool away = off > lost || off > tracker->off_before;
    tracker->off_before = off;
    return ++tracker->corrections > (tracker->found ? CORRECTIONS : CORRECTIONS_FIRST) || (tracker->found && away);
}

static void track(Tracker *tracker) {
    Reference *r = tracker->r;
    const double newton = find_directions(r, tracker->target), along = product(r, false);
    const double norm = product(r, true) + 1, squared = newton - along * along / norm;
    const double off = squared > 0 ? sqrt(squared) : squared <= 0 ? 0 : INFINITY;
    const bool forward = goes_forward(r), on_path = off <= tracker->near;
    if (on_path) {
        keep(r, KEPT_ON_PATH, tracker->target);
        tracker->found = true;
        tracker->corrections = 0;
        tracker->off_before = INFINITY;
    } else if (is_lost(tracker, off)) {
        go_back(tracker);
        return;
    }
    const double ahead = on_path ? tracker->length / sqrt(norm) : 0;
    const double by = (forward ? -ahead : ahead) - along / norm, share = advance(tracker, by);
    if (on_path) choose_length(tracker, share, off);
    if (!forward || tracker->length < 0.25)
        tracker->good = 0;
    else if (on_path && by < -0.3)
        tracker->good++;
}

static bool pass_fold(Reference *r, bool to_end) {
    return_to(r, KEPT_ON_WAY);
    Tracker tracker = {.r = r,
                       .target = mean_product(r),
                       .length = length_first,
                       .near = to_end ? nearer : near_path,
                       .off_before = INFINITY};
    keep(r, KEPT_ON_PATH, tracker.target);
    while (r->left > 0 && (to_end ? tracker.target > target_end : tracker.good < GOOD_STEPS)) {
        track(&tracker);
        if (!(tracker.target > 0 && tracker.target < INFINITY) || tracker.length < length_least ||
            (!tracker.found && tracker.corrections == 0))
            return false;
    }
    keep(r, KEPT_ON_WAY, tracker.target);
    return true;
}
