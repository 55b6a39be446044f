/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interior points with a sparse direct solve over the bodies (methods/block_lu.h), run to the end.

   1. Two sweeps of projected Gauss-Seidel from the warm start. If the contact states they lead to (open, sticking,
      sliding) are those of a solution, a linear solve finds it (polish): nearly always at rest.
   2. Else the central path is followed to the solution, also where it turns back.
   3. If the path is lost, again from another distance and with another stiffness; then from other starts: what more
      sweeps make of the best answer so far, and of no impulses. A path that is lost from one start mostly ends from
      another.
   4. Then all of these again, with impulses measured by the heaviest body (weigh).

   The solution of 1 is the one that the sweeps lead to; that of 2 is the end of the central path, which does not depend
   on the start. Included once by each reference_*.c. */
#include "methods/block_lu.h"
#include "methods/block_lu_code.h"
#include "methods/reference.h"
#include "methods/reference_parts.h"
#include "nets/activation.h"

#include <string.h>

/* The linear systems of the reference: with M the masses and J_n, J_t the rows,

       (M + J_n^T D_n J_n + J_t^T (s D_n J_n + D_t J_t)) dv = J^T (impulses of the right-hand side) - M v,

   where v is the change of velocity so far. Impulses then change by dl = r_n - D_n J_n dv and
   dt = r_t + s dl - D_t J_t dv. */

/* x += J^T impulses, of a group's pairs */
static inline void push(const BlockPair pairs[BLOCK_PAIRS], Vec4 normal, Vec4 tangent, Vec4 *x) {
    for (int half = 0, slot = 0; half < BLOCK_PAIRS; half++, slot += 2) {
        const BlockPair *pair = &pairs[half];
        const Vec4 force = pair->normal[0] * normal[slot] + pair->tangent[0] * tangent[slot] +
                           pair->normal[1] * normal[slot + 1] + pair->tangent[1] * tangent[slot + 1];
        x[pair->a] += as_body_a(force);
        x[pair->b] += force;
    }
}

static inline Vec4 between(const BlockPair *pair, const Vec4 *x) {
    const Vec4 a = x[pair->a], b = x[pair->b];
    return (Vec4){b[0] - a[0], b[1] - a[1], b[2], a[2]};
}

static inline void look_at(ReferenceGroup *g, const BlockPair pairs[BLOCK_PAIRS], const Vec4 *moved) {
    const Relative by = relative(&g->rows, pairs, moved);
    g->gap = g->free_normal + by.normal;
    g->slip = g->free_tangent + by.tangent;
}

static void look(Reference *r) {
    for (int i = 0; i < r->group_count; i++) look_at(&r->groups[i], &r->pairs[BLOCK_PAIRS * i], r->moved);
}

static void apply(Reference *r) {
    memset(r->moved, 0, ((size_t)r->graph.lu.count + 1) * sizeof *r->moved);
    for (int i = 0; i < r->group_count; i++)
        push(&r->pairs[BLOCK_PAIRS * i], r->groups[i].normal, r->groups[i].tangent, r->moved);
    for (int k = 0; k <= r->graph.lu.count; k++) r->moved[k] *= r->graph.inverses[k];
    look(r);
}

static inline Vec4 magnitude(Vec4 x) { return larger4(x, -x); }

static double missed(Reference *r, double *rms) {
    Vec4 most = all4(0), sum = all4(0);
    for (int i = 0; i < r->group_count; i++) {
        const ReferenceGroup *g = &r->groups[i];
        const Vec4 close = g->normal * g->inverse_normal;
        const Vec4 normal = magnitude(g->weight * choose4((Mask4)(close < g->gap), close, g->gap));
        const Vec4 wanted = clamp_between(g->tangent - g->mass_tangent * g->slip, g->friction * g->normal);
        const Vec4 tangent = magnitude(g->weight * (g->tangent - wanted) * g->inverse_tangent);
        most = larger4(normal, larger4(tangent, most));
        sum += normal * normal + tangent * tangent;
    }
    double largest = 0;
    for (int k = 0; k < BLOCK_SLOTS; k++) largest = most[k] > largest ? most[k] : largest;
    const double total = sum4(sum);
    if (rms != NULL) *rms = r->contact_count > 0 ? sqrt(total / r->contact_count) : 0;
    return isnan(total) ? (double)NAN : largest;
}

static void factor_matrix(Reference *r) {
    BlockLu *lu = &r->graph.lu;
    begin_blocks(&r->graph);
    for (int i = 0; i < BLOCK_PAIRS * r->group_count; i++) {
        Vec4 columns[4];
        const ReferenceGroup *g = &r->groups[i / BLOCK_PAIRS];
        block_stiffness(&r->pairs[i], i % BLOCK_PAIRS * 2, g->dn, g->dt, g->s, columns);
        block_add_pair(lu->blocks, r->pairs[i].a, r->pairs[i].b, r->pairs[i].place, columns);
    }
    block_lu_factor(lu);
    r->factorizations++;
}

/* The right-hand side without its impulses, into `changes`. */
static void momentum_left(Reference *r) {
    for (int k = 0; k < r->graph.lu.count; k++) r->changes[k] = -r->graph.masses[k] * r->moved[k];
    r->changes[r->graph.lu.count] = all4(0);
}

static void solve_changes(Reference *r) {
    block_lu_solve(&r->graph.lu, r->changes);
    r->changes[r->graph.lu.count] = all4(0);
}

/* Interior points on the way to the solution. A point on the central path of the target c (m/s)^2 satisfies

       M v = J_n^T l + J_t^T t,   z = J_n v + free,   q - p = J_t v + free,
       l z = c m_n,   (mu l - t) p = (mu l + t) q = c m_t mu,

   with masses m_n and m_t of each contact (weigh), all of l, z, mu l - t, mu l + t, p, q positive; for c = 0 this is
   the contact problem. Steps are Newton's, with Mehrotra's choice of the next target and his correction of second
   order, cut short before the nearest bound. Contacts may be redundant: a tiny compliance around the current impulses
   keeps the system regular and does not move its solution. Sources: Mehrotra, "On the Implementation of a Primal-Dual
   Interior Point Method" (1992); Friedlander, Orban, "A Primal-Dual Regularized Interior-Point Method for Convex
   Quadratic Programs" (2012). */

/* Of `calm`, the unit of speeds: gaps between the velocities and z, p, q that are rounding errors. Corrected, they
   would throw z, p, q about. */
static const double rounding = 1e-10;
static const double inside = 0.5;        /* of the start: offset from the bounds, share of the scale */
static const double bound_share = 0.995; /* of the way to the nearest bound that a step may go */
static const double least_shrink = 1e-4; /* of the target, in a step */

static Vec4 beyond_rounding(Vec4 x, double calm) { return x - clamp_between(x, all4(rounding * calm)); }

/* The masses m_n and m_t: each contact's own effective masses, or the mass of the heaviest body for all contacts. A
   light box between heavy ones passes on impulses that are many thousand times larger than those that move it. Measured
   by its own masses, they are so far from the start that the path is lost on the way. */
static void weigh(Reference *r, bool by_heaviest) {
    double most = 0;
    for (int k = 0; k < r->graph.lu.count; k++)
        if (r->graph.inverses[k][0] > 0) most = r->graph.masses[k][0] > most ? r->graph.masses[k][0] : most;
    for (int i = 0; i < r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i];
        const Mask4 heavy = (Mask4)(g->weight > all4(by_heaviest && most > 0 ? 0 : 1));
        g->load_normal = choose4(heavy, all4(most), g->mass_normal);
        g->load_tangent = choose4(heavy, all4(most), g->mass_tangent);
    }
}

static void begin(Reference *r, double scale) {
    double rms;
    for (int i = 0; i < r->group_count; i++) {
        r->groups[i].normal = r->groups[i].start_normal;
        r->groups[i].tangent = r->groups[i].start_tangent;
    }
    apply(r);
    missed(r, &rms);
    const Vec4 off = all4(inside * (scale * rms + r->calm)), zero = all4(0), one = all4(1);
    for (int i = 0; i < r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i];
        ReferencePoint *now = &g->now;
        const Mask4 used = (Mask4)(g->weight > zero);
        now->l = choose4(used, g->normal + off * g->load_normal, one);
        now->t = clamp_between(g->tangent, 0.9 * g->friction * now->l);
        now->u = g->friction * now->l - now->t;
        now->w = g->friction * now->l + now->t;
        now->z = choose4(used, larger4(g->gap, zero) + off, one);
        now->p = choose4(used, larger4(-g->slip, zero) + off, one);
        now->q = choose4(used, larger4(g->slip, zero) + off, one);
    }
}

/* Those of the matrix. */
static inline void linearise(ReferenceGroup *g, Vec4 soft, double calm) {
    const ReferencePoint *now = &g->now;
    const Vec4 p = now->p / now->u, q = now->q / now->w;
    g->missing_normal = beyond_rounding(g->gap - now->z, calm);
    g->missing_tangent = beyond_rounding(g->slip - (now->q - now->p), calm);
    g->over_z = 1 / (now->z + now->l * soft * g->inverse_normal);
    g->dn = now->l * g->over_z;
    g->dt = 1 / (p + q + soft * g->inverse_tangent);
    g->s = g->friction * (p - q) * g->dt;
}

/* Products of the target, less `second` times those of the changes in `step`. */
static inline void towards(ReferenceGroup *g, double target, double second) {
    const ReferencePoint *now = &g->now, *by = &g->step;
    const Vec4 along = target * g->load_tangent * g->friction;
    g->wanted_n = target * g->load_normal - now->l * now->z;
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
    push(&r->pairs[BLOCK_PAIRS * i], now->l + g->rn, now->t + g->rt + g->s * g->rn, r->changes);
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
    const Vec4 normal = larger4(-by->l / now->l, -by->z / now->z);
    const Vec4 up = larger4(-by->u / now->u, -by->p / now->p);
    const Vec4 down = larger4(-by->w / now->w, -by->q / now->q);
    return larger4(normal, larger4(up, down));
}

/* The share of `step` that leads to the nearest bound. */
static double room_for(Vec4 most) {
    double worst = 1e-9;
    for (int k = 0; k < BLOCK_SLOTS; k++) worst = most[k] > worst ? most[k] : worst;
    return 1 / worst;
}

/* A Newton step towards products of the target, into `step`, is begun, with a matrix that is factorized, and ended, */
static void begin_step(Reference *r, double target) {
    const Vec4 soft = all4(1 / r->stiffest);
    momentum_left(r);
    for (int i = 0; i < r->group_count; i++) {
        linearise(&r->groups[i], soft, r->calm);
        towards(&r->groups[i], target, 0);
        push_right_side(r, i);
    }
    factor_matrix(r);
    r->left--;
}

/* or another one is begun with the same matrix; */
static void begin_next_step(Reference *r, double target, double second) {
    momentum_left(r);
    for (int i = 0; i < r->group_count; i++) {
        towards(&r->groups[i], target, second);
        push_right_side(r, i);
    }
}

/* the solve. Returns the share of the step that leads to the nearest bound. */
static double end_step(Reference *r) {
    const Vec4 soft = all4(1 / r->stiffest);
    Vec4 most = all4(0);
    solve_changes(r);
    for (int i = 0; i < r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i];
        direction(g, relative(&g->rows, &r->pairs[BLOCK_PAIRS * i], r->changes), soft);
        most = larger4(nearest_bound(&g->now, &g->step), most);
    }
    return room_for(most);
}

static inline Vec4 products(const ReferenceGroup *g, Vec4 normal, Vec4 up, Vec4 down) {
    const Vec4 one = all4(1);
    return g->weight * (normal * (one / g->load_normal) + (up + down) * (one / g->load_tangent) / g->friction);
}

/* The mean of the products, over their masses: the target that the point is nearest to. */
static double mean_product(const Reference *r) {
    Vec4 sum = all4(0);
    for (int i = 0; i < r->group_count; i++) {
        const ReferencePoint *now = &r->groups[i].now;
        sum += products(&r->groups[i], now->l * now->z, now->u * now->p, now->w * now->q);
    }
    return sum4(sum) / (3 * r->contact_count);
}

/* The same after a share of the step. */
static double mean_product_after(const Reference *r, double share) {
    Vec4 sum = all4(0);
    for (int i = 0; i < r->group_count; i++) {
        const ReferenceGroup *g = &r->groups[i];
        const ReferencePoint *now = &g->now, *by = &g->step;
        sum += products(g, (now->l + share * by->l) * (now->z + share * by->z),
                        (now->u + share * by->u) * (now->p + share * by->p),
                        (now->w + share * by->w) * (now->q + share * by->q));
    }
    return sum4(sum) / (3 * r->contact_count);
}

static inline void move_point(ReferenceGroup *g, double share) {
    const Vec4 half = all4(0.5);
    ReferencePoint *now = &g->now;
    const ReferencePoint *by = &g->step;
    now->l += share * by->l;
    now->z += share * by->z;
    now->p += share * by->p;
    now->q += share * by->q;
    const Vec4 u = now->u + share * by->u, w = now->w + share * by->w, both = 2 * g->friction * now->l;
    const Mask4 slides_up = (Mask4)(u < w); /* the smaller one is precise */
    now->u = choose4(slides_up, u, both - w);
    now->w = choose4(slides_up, both - u, w);
    now->t = half * (now->w - now->u);
}

static void move(Reference *r, double share) {
    for (int k = 0; k < r->graph.lu.count; k++) r->moved[k] += share * r->changes[k];
    for (int i = 0; i < r->group_count; i++) {
        move_point(&r->groups[i], share);
        look_at(&r->groups[i], &r->pairs[BLOCK_PAIRS * i], r->moved);
    }
}

static void keep(Reference *r, int place, double target) {
    for (int i = 0; i < r->group_count; i++) r->kept[place].points[i] = r->groups[i].now;
    memcpy(r->kept[place].moved, r->moved, ((size_t)r->graph.lu.count + 1) * sizeof *r->moved);
    r->kept[place].target = target;
}

static double return_to(Reference *r, int place) {
    for (int i = 0; i < r->group_count; i++) r->groups[i].now = r->kept[place].points[i];
    memcpy(r->moved, r->kept[place].moved, ((size_t)r->graph.lu.count + 1) * sizeof *r->moved);
    look(r);
    return r->kept[place].target;
}

/* The sign of the determinant, from the diagonal of the factors: it changes where the path turns back. */
static bool goes_forward(const Reference *r) {
    bool forward = true;
    for (int k = 0; k < r->graph.lu.count; k++)
        for (int c = 0; c < 3; c++) forward ^= r->graph.lu.blocks[k].column[c][c] < 0;
    return forward;
}

/* With friction the central path may turn back: its target rises for a while before it falls again, and Newton's method
   ends at the fold. So the path is followed by its length, with the target as one more unknown. At a fold the
   determinant changes its sign, which tells in what direction to continue. Lengths are measured in the logarithms of
   the point, which is natural inside of bounds. Source: Allgower, Georg, "Numerical Continuation Methods" (1990):
   Euler-Newton with orientation by the determinant. */

enum { CORRECTIONS = 3, CORRECTIONS_FIRST = 20, GOOD_STEPS = 3 };

static const double arc_share = 0.9;                          /* of the way to the nearest bound that a step may go */
static const double near_path = 0.5, nearer = 0.25, lost = 3; /* distances from the path, in its length */
static const double length_first = 0.5, length_most = 8, length_least = 1e-5;

static const double target_end = 1e-6; /* of calm^2 */

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
    Vec4 sum = all4(0);
    for (int i = 0; i < r->group_count; i++) {
        const ReferencePoint *now = &r->groups[i].now, *x = &r->groups[i].step;
        const ReferencePoint *y = with_itself ? x : &r->groups[i].along;
        const Vec4 normal = x->l * y->l / (now->l * now->l) + x->z * y->z / (now->z * now->z);
        const Vec4 up = x->u * y->u / (now->u * now->u) + x->p * y->p / (now->p * now->p);
        sum += normal + up + x->w * y->w / (now->w * now->w) + x->q * y->q / (now->q * now->q);
    }
    return sum4(sum) / (3 * r->contact_count);
}

static ReferencePoint combine(const ReferencePoint *x, double share, const ReferencePoint *y) {
    return (ReferencePoint){x->l + share * y->l, x->t + share * y->t, x->u + share * y->u, x->w + share * y->w,
                            x->z + share * y->z, x->p + share * y->p, x->q + share * y->q};
}

/* Newton's step at the present target into `along`, and the derivative by the logarithm of the target into `step`.
   Returns the square of the former's length. */
static double find_directions(Reference *r, double target) {
    const size_t bodies = (size_t)r->graph.lu.count;
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

/* Newton's step plus `by` times the derivative. Returns the share of it that the bounds allow. */
static double advance(Tracker *tracker, double by) {
    Reference *r = tracker->r;
    for (int i = 0; i < r->group_count; i++) r->groups[i].step = combine(&r->groups[i].along, by, &r->groups[i].step);
    for (int k = 0; k < r->graph.lu.count; k++) r->changes[k] = r->first_changes[k] + by * r->changes[k];
    Vec4 most = all4(0);
    for (int i = 0; i < r->group_count; i++) most = larger4(nearest_bound(&r->groups[i].now, &r->groups[i].step), most);
    const double limit = arc_share * room_for(most), share = limit < 1 ? limit : 1;
    move(r, share);
    /* After a change of its logarithm; NaN after one that only a lost path makes. */
    tracker->target = fabs(share * by) <= 700 ? tracker->target * exponential(share * by) : NAN;
    return share;
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
    } else {
        const bool away = off > lost || off > tracker->off_before;
        const int most = tracker->found ? CORRECTIONS : CORRECTIONS_FIRST;
        tracker->off_before = off;
        if (++tracker->corrections > most || (tracker->found && away)) {
            /* Back to the last point on the path, for shorter steps. */
            tracker->target = return_to(r, KEPT_ON_PATH);
            tracker->length *= 0.25;
            tracker->corrections = 0;
            tracker->off_before = INFINITY;
            return;
        }
    }
    const double ahead = on_path ? tracker->length / sqrt(norm) : 0;
    const double by = (forward ? -ahead : ahead) - along / norm, share = advance(tracker, by);
    if (on_path && share >= 1 && off < 0.3)
        tracker->length = 2 * tracker->length < length_most ? 2 * tracker->length : length_most;
    else if (on_path && share < 0.7)
        tracker->length *= 0.5;
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
    while (r->left > 0 && (to_end ? tracker.target > target_end * r->calm * r->calm : tracker.good < GOOD_STEPS)) {
        track(&tracker);
        if (!(tracker.target > 0 && tracker.target < INFINITY) || tracker.length < length_least ||
            (!tracker.found && tracker.corrections == 0))
            return false;
    }
    keep(r, KEPT_ON_WAY, tracker.target);
    return true;
}

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
    const Vec4 zero = all4(0), one = all4(1);
    for (int i = 0; i < r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i];
        const ReferencePoint *now = &g->now;
        const Vec4 inverse_normal = one / g->load_normal, inverse_tangent = one / g->load_tangent;
        const Mask4 closed = (Mask4)(now->l * inverse_normal > now->z);
        g->normal = choose4(closed, now->l, zero);
        const Vec4 bound = g->friction * g->normal;
        const Mask4 up = (Mask4)(now->u * inverse_tangent < now->p), down = (Mask4)(now->w * inverse_tangent < now->q);
        g->tangent = choose4(up, bound, choose4(down, -bound, clamp_between(now->t, bound)));
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

/* Short steps in a row that end an attempt which had no long one yet: where masses differ much, dozens lead to the
   path. */
enum { PATIENCE = 40 };

static bool follow(Reference *r, int most, bool carefully) {
    const double good = 0.8, short_step = 0.1;
    int stuck = 0;
    bool begun = false;
    double mean = mean_product(r);
    for (r->left = most; r->left > 0;) {
        const double length = centre_step(r, mean);
        mean = mean_product(r);
        if (!(mean > 0) || isinf(mean)) break;
        if (mean < r->calm * r->calm) answer(r);
        if (r->best <= r->aim || (r->best <= r->enough && length < 0.5)) return true;
        const bool forward = goes_forward(r);
        if (length >= good && forward) {
            keep(r, KEPT_ON_WAY, mean);
            begun = true;
        }
        stuck = length < short_step || !forward ? stuck + 1 : 0;
        if (stuck < (begun || !(r->persist || r->by_heaviest) ? 2 : PATIENCE) && !(carefully && length >= good))
            continue;
        if (!begun || !pass_fold(r, carefully)) break;
        mean = mean_product(r);
        stuck = 0;
        carefully = false;
    }
    answer(r);
    return r->best <= r->enough;
}

static double clamp(double x, double limit) { return x > limit ? limit : x < -limit ? -limit : x; }
static double larger(double x, double y) { return x > y ? x : y; }

/* One contact: first its normal impulse, then its tangent impulse. Returns the larger change. */
static double visit(Reference *r, const BlockPair *pair, ReferenceGroup *g, int slot) {
    Vec4 *a = &r->moved[pair->a], *b = &r->moved[pair->b];
    const int k = slot % 2;
    const double gap = g->free_normal[slot] + sum4(pair->normal[k] * between(pair, r->moved));
    const double normal = larger(g->normal[slot] - g->mass_normal[slot] * gap, 0), dn = normal - g->normal[slot];
    *a += r->graph.inverses[pair->a] * as_body_a(pair->normal[k] * all4(dn));
    *b += r->graph.inverses[pair->b] * (pair->normal[k] * all4(dn));
    const double slip = g->free_tangent[slot] + sum4(pair->tangent[k] * between(pair, r->moved));
    const double tangent = clamp(g->tangent[slot] - g->mass_tangent[slot] * slip, g->friction[slot] * normal);
    const double dt = tangent - g->tangent[slot];
    *a += r->graph.inverses[pair->a] * as_body_a(pair->tangent[k] * all4(dt));
    *b += r->graph.inverses[pair->b] * (pair->tangent[k] * all4(dt));
    g->normal[slot] = normal;
    g->tangent[slot] = tangent;
    return larger(fabs(dn) * g->inverse_normal[slot], fabs(dt) * g->inverse_tangent[slot]);
}

static double sweep(Reference *r) {
    double most = 0;
    for (int i = 0; i < r->pair_count; i++)
        for (int k = 0; k < r->first[i + 1] - r->first[i]; k++) {
            ReferenceGroup *group = &r->groups[i / BLOCK_PAIRS];
            const int slot = i % BLOCK_PAIRS * 2 + k;
            if (!(group->weight[slot] > 0)) continue;
            const double change = visit(r, &r->pairs[i], group, slot);
            most = change > most || isnan(change) ? change : most;
        }
    return most;
}

/* The solve. */

/* Contact states by the next visit of sequential impulses: open, sticking or sliding. For given states the contact
   problem is linear. Where contacts are redundant it has no or many solutions; a large stiffness keeps it regular, and
   has no effect once the impulses stay (the proximal point method). Impulses of redundant contacts may have far to go
   at tiny velocities, until one of them slides or opens: visits with more than the effective mass look ahead. */

enum { POLISH_STEPS = 3 };

static const double stiff = 1e12; /* times the effective mass */

/* ahead: of the visit, times the effective mass. */
static void guess_states(Reference *r, double ahead) {
    const Vec4 zero = all4(0), factor = all4(ahead > 1 ? ahead : stiff);
    momentum_left(r);
    for (int i = 0; i < r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i];
        const Vec4 l = g->normal - ahead * g->mass_normal * g->gap, t = g->tangent - ahead * g->mass_tangent * g->slip;
        const Mask4 closed = (Mask4)(l > zero), up = closed & (Mask4)(t > g->friction * l),
                    down = closed & (Mask4)(t < -g->friction * l), sticks = closed & ~up & ~down;
        const Vec4 stiff_n = factor * g->mass_normal, stiff_t = factor * g->mass_tangent;
        g->s = choose4(up, g->friction, choose4(down, -g->friction, zero));
        g->dn = choose4(closed, stiff_n, zero);
        g->dt = choose4(sticks, stiff_t, zero);
        g->rn = choose4(closed, -stiff_n * g->gap, -g->normal);
        g->rt = choose4(sticks, -stiff_t * g->slip, g->s * g->normal - g->tangent);
        push(&r->pairs[BLOCK_PAIRS * i], g->normal + g->rn, g->tangent + g->rt + g->s * g->rn, r->changes);
    }
}

static void take_impulses(Reference *r) {
    for (int i = 0; i < r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i];
        const Relative change = relative(&g->rows, &r->pairs[BLOCK_PAIRS * i], r->changes);
        const Vec4 by = g->rn - g->dn * change.normal;
        const Vec4 tangent = g->tangent + g->rt + g->s * by - g->dt * change.tangent;
        g->normal = larger4(g->normal + by, all4(0));
        g->tangent = clamp_between(tangent, g->friction * g->normal);
    }
}

static double polish(Reference *r, double aim, double ahead) {
    double miss = missed(r, NULL), before = INFINITY;
    for (int i = 0; i < POLISH_STEPS && miss > aim && (ahead > 1 || miss < 0.5 * before); i++) {
        before = miss;
        guess_states(r, ahead);
        factor_matrix(r);
        solve_changes(r);
        take_impulses(r);
        apply(r);
        miss = missed(r, NULL);
    }
    return miss;
}

enum { FINISH_ROUNDS = 3, FINISH_SWEEPS = 100 };

/* The first start is the warm start, the others the best answer or no impulses; then sweeps. */
static const struct {
    int sweeps;
    bool from_nothing, by_heaviest;
} starts[] = {{2, false, false},  {100, false, false}, {100, true, false}, {800, false, false}, {800, true, false},
              {100, false, true}, {100, true, true},   {800, false, true}, {800, true, true}};

/* scale: distance of the start from its bounds, times its residual. stiffest: see Reference; with less, redundant
   contacts drift, with more, rounding hides the masses. most: factorizations. carefully: by the path's length. */
static const struct {
    double scale, stiffest;
    int most;
    bool carefully;
} attempts[] = {{3, 1e12, 200, false},  {30, 1e13, 200, false}, {300, 1e12, 200, false}, {30, 1e12, 400, true},
                {300, 1e13, 400, true}, {3, 1e14, 400, true},   {10, 1e11, 400, true},   {1000, 1e12, 400, true}};
static const double look_ahead[] = {1e3, 1e6, 1e9, 1e11, 1e13};

static void take_best(Reference *r) {
    for (int i = 0; i < r->group_count; i++) {
        r->groups[i].normal = r->groups[i].best_normal;
        r->groups[i].tangent = r->groups[i].best_tangent;
    }
    apply(r);
}

static bool is_rough(const Reference *r) { return r->best > r->enough && r->best < near_solution * r->calm; }

/* Near the solution the states of most contacts are clear, and sweeps find those of the others. */
static bool finish(Reference *r) {
    const int count = sizeof look_ahead / sizeof *look_ahead;
    for (int round = 0; round < FINISH_ROUNDS && is_rough(r); round++) {
        for (int i = 0; i < count && is_rough(r); i++) {
            take_best(r);
            keep_best(r, polish(r, r->aim, look_ahead[i]));
        }
        take_best(r);
        for (int i = 0; i < FINISH_SWEEPS && is_rough(r); i++) sweep(r);
        apply(r);
        keep_best(r, missed(r, NULL));
    }
    return r->best <= r->enough;
}

static void sweep_start(Reference *r, int sweeps) {
    for (int i = 0; i < sweeps; i++) sweep(r);
    apply(r);
    for (int i = 0; i < r->group_count; i++) {
        r->groups[i].start_normal = r->groups[i].normal;
        r->groups[i].start_tangent = r->groups[i].tangent;
    }
    keep_best(r, missed(r, NULL));
    keep_best(r, polish(r, r->aim, 1));
}

static bool try_all(Reference *r) {
    const int count = sizeof attempts / sizeof *attempts;
    bool solved = r->best <= r->aim;
    for (int i = 0; !solved && i < count && r->factorizations < r->most; i++) {
        const int left = r->most - r->factorizations, most = attempts[i].most;
        r->attempts++;
        r->stiffest = attempts[i].stiffest;
        begin(r, attempts[i].scale);
        solved = follow(r, most < left ? most : left, attempts[i].carefully) || finish(r);
    }
    return solved;
}

static void run(Reference *r) {
    const int count = sizeof starts / sizeof *starts;
    apply(r);
    r->best = INFINITY;
    weigh(r, r->by_heaviest || starts[0].by_heaviest);
    sweep_start(r, starts[0].sweeps);
    bool solved = try_all(r);
    for (int i = 1; r->persist && !solved && i < count && r->factorizations < r->most; i++) {
        weigh(r, starts[i].by_heaviest);
        take_best(r);
        for (int k = 0; starts[i].from_nothing && k < r->group_count; k++)
            r->groups[k].normal = r->groups[k].tangent = all4(0);
        apply(r);
        sweep_start(r, starts[i].sweeps);
        solved = try_all(r);
    }
    take_best(r);
}

static double residual_of(Reference *r) {
    apply(r);
    return sweep(r);
}

const ReferenceKernels KERNELS = {run, residual_of};
