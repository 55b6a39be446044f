/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interior points with a sparse direct solve over the bodies (methods/block_lu.h), run to the end.

   1. Two sweeps of projected Gauss-Seidel from the warm start. If the contact states they lead to (open, sticking,
      sliding) are those of a solution, a linear solve finds it (polish): nearly always at rest.
   2. Else the central path is followed to the solution (reference_path_code.h), also where it turns back.
   3. If the path is lost, again from another distance and with another stiffness; then from other starts: what more
      sweeps make of the best answer so far, and of no impulses. A path that is lost from one start mostly ends from
      another.
   4. Then all of these again, with impulses measured by the heaviest body (weigh).

   The solution of 1 is the one that the sweeps lead to; that of 2 is the end of the central path, which does not depend
   on the start. Included once by each reference_*.c. */
#include "methods/reference_newton_code.h"
#include "methods/reference_path_code.h"

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

static bool is_rough(const Reference *r) { return r->best > r->enough && r->best < near_solution; }

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
    weigh(r, starts[0].by_heaviest);
    sweep_start(r, starts[0].sweeps);
    bool solved = try_all(r);
    for (int i = 1; r->persist && !solved && i < count; i++) {
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
