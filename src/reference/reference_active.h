/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact states by the next visit of sequential impulses: open, sticking or sliding. For given states the contact
   problem is linear. Where contacts are redundant it has no or many solutions; a large stiffness keeps it regular, and
   has no effect once the impulses stay (the proximal point method). Impulses of redundant contacts may have far to go
   at tiny velocities, until one of them slides or opens: visits with more than the effective mass look ahead. */
#pragma once
#include "reference/reference_newton.h"

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
