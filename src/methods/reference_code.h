/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include "methods/reference.h"
#include "nets/nets.h"

/* Contact states by the next visit of sequential impulses: open, sticking or sliding. For given states the contact
   problem is linear. Where contacts are redundant it has no or many solutions; a large stiffness keeps it regular, and
   has no effect once the impulses stay (the proximal point method). Impulses of redundant contacts may have far to go
   at tiny velocities, until one of them slides or opens: visits with more than the effective mass look ahead. */
#include "methods/reference_newton.h"

enum { POLISH_STEPS = 3 };

static const double stiff = 1e12; /* times the effective mass */

/* ahead: of the visit, times the effective mass. */
static void guess_states(Reference *r, double ahead) {
    const Vec4 zero = reference_all(0), factor = reference_all(ahead > 1 ? ahead : stiff);
    momentum_left(r);
    for (int i = 0; i < r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i];
        const Vec4 l = g->normal - ahead * g->mass_normal * g->gap, t = g->tangent - ahead * g->mass_tangent * g->slip;
        const ReferenceMask closed = (ReferenceMask)(l > zero), up = closed & (ReferenceMask)(t > g->friction * l),
                            down = closed & (ReferenceMask)(t < -g->friction * l), sticks = closed & ~up & ~down;
        const Vec4 stiff_n = factor * g->mass_normal, stiff_t = factor * g->mass_tangent;
        g->s = reference_choose(up, g->friction, reference_choose(down, -g->friction, zero));
        g->dn = reference_choose(closed, stiff_n, zero);
        g->dt = reference_choose(sticks, stiff_t, zero);
        g->rn = reference_choose(closed, -stiff_n * g->gap, -g->normal);
        g->rt = reference_choose(sticks, -stiff_t * g->slip, g->s * g->normal - g->tangent);
        push(&r->pairs[REFERENCE_PAIRS * i], g->normal + g->rn, g->tangent + g->rt + g->s * g->rn, r->changes);
    }
}

static void take_impulses(Reference *r) {
    for (int i = 0; i < r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i];
        const Relative change = relative(g, &r->pairs[REFERENCE_PAIRS * i], r->changes);
        const Vec4 by = g->rn - g->dn * change.normal;
        const Vec4 tangent = g->tangent + g->rt + g->s * by - g->dt * change.tangent;
        g->normal = reference_larger(g->normal + by, reference_all(0));
        g->tangent = reference_clamp(tangent, g->friction * g->normal);
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

/* Interior points with a sparse direct solve over the bodies (methods/block_lu.h), run to the end.

   1. Two sweeps of projected Gauss-Seidel from the warm start. If the contact states they lead to (open, sticking,
      sliding) are those of a solution, a linear solve finds it: nearly always at rest.
   2. Else the central path is followed to the solution, also where it turns back (reference_path.h).
   3. If the path is lost, again from another distance and with another stiffness.

   The solution of 1 is the one that the sweeps lead to; that of 2 is the end of the central path, which does not depend
   on the start. */
#include "methods/reference_path.h"

enum { START_SWEEPS = 2, FINISH_ROUNDS = 3, FINISH_SWEEPS = 100 };

/* scale: distance of the start from its bounds, times its residual. stiffest: see Reference; with less, redundant
   contacts drift, with more, rounding hides the masses. most: factorizations. carefully: by the path's length. */
static const struct {
    double scale, stiffest;
    int most;
    bool carefully;
} attempts[] = {{3, 1e12, 200, false},  {30, 1e13, 200, false}, {300, 1e12, 200, false}, {30, 1e12, 400, true},
                {300, 1e13, 400, true}, {3, 1e14, 400, true},   {10, 1e11, 400, true},   {1000, 1e12, 400, true}};
static const double look_ahead[] = {1e3, 1e6, 1e9, 1e11, 1e13}, near_solution = 1e-5; /* m/s */

static void keep_start(Reference *r) {
    for (int i = 0; i < r->group_count; i++) {
        r->groups[i].start_normal = r->groups[i].normal;
        r->groups[i].start_tangent = r->groups[i].tangent;
    }
}

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

static void run(Reference *r) {
    for (int i = 0; i < START_SWEEPS; i++) sweep(r);
    apply(r);
    keep_start(r);
    r->best = INFINITY;
    keep_best(r, missed(r, NULL));
    keep_best(r, polish(r, r->aim, 1));
    const int count = sizeof attempts / sizeof *attempts;
    bool solved = r->best <= r->aim;
    for (; !solved && r->attempts < count && r->factorizations < r->most; r->attempts++) {
        const int left = r->most - r->factorizations, most = attempts[r->attempts].most;
        r->stiffest = attempts[r->attempts].stiffest;
        begin(r, attempts[r->attempts].scale);
        solved = follow(r, most < left ? most : left, attempts[r->attempts].carefully) || finish(r);
    }
    take_best(r);
}

static void run_from(Reference *r) {
    apply(r);
    run(r);
}

static double residual_of(Reference *r) {
    apply(r);
    return sweep(r);
}

const ReferenceKernels KERNELS = {run_from, residual_of};
