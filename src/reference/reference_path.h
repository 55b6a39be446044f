/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include "reference/reference_arc.h"

/* Keeps the impulses if they are the best so far. */
static void keep_best(Reference *r, double miss) {
    if (!(miss < r->best)) return;
    r->best = miss;
    for (int i = 0; i < r->group_count; i++) {
        r->groups[i].best_normal = r->groups[i].normal;
        r->groups[i].best_tangent = r->groups[i].tangent;
    }
}

/* The impulses that the point stands for: bounds that it is close to are reached. Keeps them if they are the best. */
static void answer(Reference *r) {
    const Vec4 zero = reference_all(0);
    for (int i = 0; i < r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i];
        const ReferencePoint *now = &g->now;
        const ReferenceMask closed = (ReferenceMask)(now->l * g->inverse_normal > now->z);
        g->normal = reference_choose(closed, now->l, zero);
        const Vec4 bound = g->friction * g->normal;
        const ReferenceMask up = (ReferenceMask)(now->u * g->inverse_tangent < now->p),
                            down = (ReferenceMask)(now->w * g->inverse_tangent < now->q);
        g->tangent = reference_choose(up, bound, reference_choose(down, -bound, reference_clamp(now->t, bound)));
    }
    Vec4 *moved = r->moved;
    r->moved = r->changes;
    apply(r);
    r->moved = moved;
    const double miss = missed(r, NULL);
    look(r);
    keep_best(r, miss);
}

static double at_most(double x, double limit) { return x < limit ? x : limit; }

/* One step from products of this mean. Returns its length, as a share of the full step. */
static double centre_step(Reference *r, double mean) {
    begin_step(r, 0);
    const double share = at_most(end_step(r), 1), ratio = mean_product_after(r, share) / mean;
    const double shrink = at_most(ratio * ratio * ratio, 1);
    begin_next_step(r, mean * (shrink > least_shrink ? shrink : least_shrink), share);
    const double length = at_most(bound_share * end_step(r), 1);
    move(r, length);
    return length;
}

/* m/s, over effective masses. */
static double largest_impulse(const Reference *r) {
    Vec4 most = reference_all(0);
    for (int i = 0; i < r->group_count; i++) {
        const ReferenceGroup *g = &r->groups[i];
        most = reference_larger(g->weight * g->now.l * g->inverse_normal, most);
    }
    double largest = 0;
    for (int k = 0; k < REFERENCE_SLOTS; k++) largest = most[k] > largest ? most[k] : largest;
    return largest;
}

static bool follow(Reference *r, int most, bool carefully) {
    const double good = 0.8, short_step = 0.1;
    const double near_end = 1e-4 > 25 * r->aim * r->aim ? 1e-4 : 25 * r->aim * r->aim; /* (m/s)^2 */
    int stuck = 0;
    bool begun = false;
    double mean = mean_product(r);
    for (r->left = most; r->left > 0;) {
        const double length = centre_step(r, mean);
        mean = mean_product(r);
        if (!(mean > 0) || isinf(mean)) break;
        if (r->jammed < INFINITY && largest_impulse(r) > r->jammed) {
            r->most = r->factorizations; /* no further attempt */
            break;
        }
        if (mean < near_end) answer(r);
        if (r->best <= r->aim || (r->best <= r->enough && length < 0.5)) return true;
        const bool forward = goes_forward(r);
        if (length >= good && forward) {
            keep(r, KEPT_ON_WAY, mean);
            begun = true;
        }
        stuck = length < short_step || !forward ? stuck + 1 : 0;
        if (stuck < 2 && !(carefully && length >= good)) continue;
        if (!begun || !pass_fold(r, carefully)) break;
        mean = mean_product(r);
        stuck = 0;
        carefully = false;
    }
    answer(r);
    return r->best <= r->enough;
}
