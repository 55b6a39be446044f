/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interior points on the way to the solution. A point on the central path of the target c (m/s)^2 satisfies

       M v = J_n^T l + J_t^T t,   z = J_n v + free,   q - p = J_t v + free,
       l z = c m_n,   (mu l - t) p = (mu l + t) q = c m_t mu,

   all of l, z, mu l - t, mu l + t, p, q positive; for c = 0 this is the contact problem. Steps are Newton's, with
   Mehrotra's choice of the next target and his correction of second order, cut short before the nearest bound. Contacts
   may be redundant: a tiny compliance around the current impulses keeps the system regular and does not move its
   solution. Sources: Mehrotra, "On the Implementation of a Primal-Dual Interior Point Method" (1992); Friedlander,
   Orban, "A Primal-Dual Regularized Interior-Point Method for Convex Quadratic Programs" (2012). */
#pragma once
#include "reference/reference_newton.h"

/* m/s: gaps between the velocities and z, p, q that are rounding errors. Corrected, they would throw z, p, q about. */
static const double rounding = 1e-12;
static const double inside = 0.5, calm = 0.01; /* of the start: offset from the bounds, share of the scale; m/s */
static const double bound_share = 0.995;       /* of the way to the nearest bound that a step may go */
static const double least_shrink = 1e-4;       /* of the target, in a step */

static Vec4 beyond_rounding(Vec4 x) { return x - reference_clamp(x, reference_all(rounding)); }

static void begin(Reference *r, double scale) {
    double rms;
    for (int i = 0; i < r->group_count; i++) {
        r->groups[i].normal = r->groups[i].start_normal;
        r->groups[i].tangent = r->groups[i].start_tangent;
    }
    apply(r);
    missed(r, &rms);
    const Vec4 off = reference_all(inside * (scale * rms + calm)), zero = reference_all(0), one = reference_all(1);
    for (int i = 0; i < r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i];
        ReferencePoint *now = &g->now;
        const ReferenceMask used = (ReferenceMask)(g->weight > zero);
        now->l = reference_choose(used, g->normal + off * g->mass_normal, one);
        now->t = reference_clamp(g->tangent, 0.9 * g->friction * now->l);
        now->u = g->friction * now->l - now->t;
        now->w = g->friction * now->l + now->t;
        now->z = reference_choose(used, reference_larger(g->gap, zero) + off, one);
        now->p = reference_choose(used, reference_larger(-g->slip, zero) + off, one);
        now->q = reference_choose(used, reference_larger(g->slip, zero) + off, one);
    }
}

/* Those of the matrix. */
static inline void linearise(ReferenceGroup *g, Vec4 soft) {
    const ReferencePoint *now = &g->now;
    const Vec4 p = now->p / now->u, q = now->q / now->w;
    g->missing_normal = beyond_rounding(g->gap - now->z);
    g->missing_tangent = beyond_rounding(g->slip - (now->q - now->p));
    g->over_z = 1 / (now->z + now->l * soft * g->inverse_normal);
    g->dn = now->l * g->over_z;
    g->dt = 1 / (p + q + soft * g->inverse_tangent);
    g->s = g->friction * (p - q) * g->dt;
}

/* Products of the target, less `second` times those of the changes in `step`. */
static inline void towards(ReferenceGroup *g, double target, double second) {
    const ReferencePoint *now = &g->now, *by = &g->step;
    const Vec4 along = target * g->mass_tangent * g->friction;
    g->wanted_n = target * g->mass_normal - now->l * now->z;
    g->wanted_p = along - now->u * now->p;
    g->wanted_q = along - now->w * now->q;
    if (second > 0) {
        g->wanted_n -= second * by->l * by->z;
        g->wanted_p -= second * by->u * by->p;
        g->wanted_q -= second * by->w * by->q;
    }
    g->wanted_n *= g->weight;
    g->wanted_p *= g->weight;
    g->wanted_q *= g->weight;
}

static inline void push_right_side(Reference *r, int i) {
    ReferenceGroup *g = &r->groups[i];
    const ReferencePoint *now = &g->now;
    g->rn = (g->wanted_n - now->l * g->missing_normal) * g->over_z;
    g->rt = g->dt * (g->wanted_q / now->w - g->wanted_p / now->u - g->missing_tangent);
    push(&r->pairs[REFERENCE_PAIRS * i], now->l + g->rn, now->t + g->rt + g->s * g->rn, r->changes);
}

/* The changes of a group by the last solve into `step`. */
static inline void direction(ReferenceGroup *g, Relative change, Vec4 soft) {
    const ReferencePoint *now = &g->now;
    ReferencePoint *by = &g->step;
    by->l = g->rn - g->dn * change.normal;
    by->t = g->rt + g->s * by->l - g->dt * change.tangent;
    by->u = g->friction * by->l - by->t;
    by->w = g->friction * by->l + by->t;
    by->z = change.normal + g->missing_normal + by->l * soft * g->inverse_normal;
    by->p = (g->wanted_p - now->p * by->u) / now->u;
    by->q = (g->wanted_q - now->q * by->w) / now->w;
}

static inline Vec4 nearest_bound(const ReferencePoint *now, const ReferencePoint *by) {
    const Vec4 normal = reference_larger(-by->l / now->l, -by->z / now->z);
    const Vec4 up = reference_larger(-by->u / now->u, -by->p / now->p);
    const Vec4 down = reference_larger(-by->w / now->w, -by->q / now->q);
    return reference_larger(normal, reference_larger(up, down));
}

/* The share of `step` that leads to the nearest bound. */
static double room_for(Vec4 most) {
    double worst = 1e-9;
    for (int k = 0; k < REFERENCE_SLOTS; k++) worst = most[k] > worst ? most[k] : worst;
    return 1 / worst;
}

static double step_room(const Reference *r) {
    Vec4 most = reference_all(0);
    for (int i = 0; i < r->group_count; i++)
        most = reference_larger(nearest_bound(&r->groups[i].now, &r->groups[i].step), most);
    return room_for(most);
}

/* A Newton step towards products of the target, into `step`: the first solve with a matrix, which factorizes it, */
static void begin_step(Reference *r, double target) {
    const Vec4 soft = reference_all(1 / r->stiffest);
    momentum_left(r);
    for (int i = 0; i < r->group_count; i++) {
        linearise(&r->groups[i], soft);
        towards(&r->groups[i], target, 0);
        push_right_side(r, i);
    }
    factor_matrix(r);
    r->left--;
}

/* the right-hand side of another one, */
static void begin_next_step(Reference *r, double target, double second) {
    momentum_left(r);
    for (int i = 0; i < r->group_count; i++) {
        towards(&r->groups[i], target, second);
        push_right_side(r, i);
    }
}

/* and the solve. Returns the share of the step that leads to the nearest bound. */
static double end_step(Reference *r) {
    const Vec4 soft = reference_all(1 / r->stiffest);
    Vec4 most = reference_all(0);
    solve_changes(r);
    for (int i = 0; i < r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i];
        direction(g, relative(g, &r->pairs[REFERENCE_PAIRS * i], r->changes), soft);
        most = reference_larger(nearest_bound(&g->now, &g->step), most);
    }
    return room_for(most);
}

static inline Vec4 products(const ReferenceGroup *g, Vec4 normal, Vec4 up, Vec4 down) {
    return g->weight * (normal * g->inverse_normal + (up + down) * g->inverse_tangent / g->friction);
}

/* The mean of the products, over their masses: the target that the point is nearest to. */
static double mean_product(const Reference *r) {
    Vec4 sum = reference_all(0);
    for (int i = 0; i < r->group_count; i++) {
        const ReferencePoint *now = &r->groups[i].now;
        sum += products(&r->groups[i], now->l * now->z, now->u * now->p, now->w * now->q);
    }
    return reference_sum(sum) / (3 * r->contact_count);
}

/* The same after a share of the step. */
static double mean_product_after(const Reference *r, double share) {
    Vec4 sum = reference_all(0);
    for (int i = 0; i < r->group_count; i++) {
        const ReferenceGroup *g = &r->groups[i];
        const ReferencePoint *now = &g->now, *by = &g->step;
        sum += products(g, (now->l + share * by->l) * (now->z + share * by->z),
                        (now->u + share * by->u) * (now->p + share * by->p),
                        (now->w + share * by->w) * (now->q + share * by->q));
    }
    return reference_sum(sum) / (3 * r->contact_count);
}

static inline void move_point(ReferenceGroup *g, double share) {
    const Vec4 half = reference_all(0.5);
    ReferencePoint *now = &g->now;
    const ReferencePoint *by = &g->step;
    now->l += share * by->l;
    now->z += share * by->z;
    now->p += share * by->p;
    now->q += share * by->q;
    const Vec4 u = now->u + share * by->u, w = now->w + share * by->w, both = 2 * g->friction * now->l;
    const ReferenceMask slides_up = (ReferenceMask)(u < w); /* the smaller one is precise */
    now->u = reference_choose(slides_up, u, both - w);
    now->w = reference_choose(slides_up, both - u, w);
    now->t = half * (now->w - now->u);
}

static void move(Reference *r, double share) {
    for (int k = 0; k < r->lu.count; k++) r->moved[k] += share * r->changes[k];
    for (int i = 0; i < r->group_count; i++) {
        move_point(&r->groups[i], share);
        look_at(&r->groups[i], &r->pairs[REFERENCE_PAIRS * i], r->moved);
    }
}

static void keep(Reference *r, int place, double target) {
    for (int i = 0; i < r->group_count; i++) r->kept[place].points[i] = r->groups[i].now;
    memcpy(r->kept[place].moved, r->moved, ((size_t)r->lu.count + 1) * sizeof *r->moved);
    r->kept[place].target = target;
}

static double return_to(Reference *r, int place) {
    for (int i = 0; i < r->group_count; i++) r->groups[i].now = r->kept[place].points[i];
    memcpy(r->moved, r->kept[place].moved, ((size_t)r->lu.count + 1) * sizeof *r->moved);
    look(r);
    return r->kept[place].target;
}

/* The sign of the determinant, from the diagonal of the factors: it changes where the path turns back. */
static bool goes_forward(const Reference *r) {
    bool forward = true;
    for (int k = 0; k < r->lu.count; k++)
        for (int c = 0; c < 3; c++) forward ^= r->lu.blocks[k].column[c][c] < 0;
    return forward;
}
