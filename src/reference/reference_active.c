/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Contact states by the next visit of sequential impulses: open, sticking or sliding. For given states the contact
   problem is linear. Where contacts are redundant it has no or many solutions; a large stiffness instead of none keeps
   it regular, and its effect vanishes as the impulses stay (the proximal point method). */
#include "reference/reference_parts.h"

enum { POLISH_MOST = 3 };

static const double stiff = 1e12; /* times the effective mass */

/* Linear in the changes of velocity: what the visit makes of the impulses, with stiffness instead of mass. */
static void guess_states(Reference *r) {
    const Vec4 zero = reference_all(0), factor = reference_all(stiff);
    for (int i = 0; i < r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i];
        const Vec4 l = g->normal - g->mass_normal * g->gap, t = g->tangent - g->mass_tangent * g->slip;
        const ReferenceMask closed = (ReferenceMask)(l > zero), up = closed & (ReferenceMask)(t > g->friction * l),
                            down = closed & (ReferenceMask)(t < -g->friction * l), sticks = closed & ~up & ~down;
        const Vec4 stiff_n = factor * g->mass_normal, stiff_t = factor * g->mass_tangent;
        g->s = reference_choose(up, g->friction, reference_choose(down, -g->friction, zero));
        g->dn = reference_choose(closed, stiff_n, zero);
        g->dt = reference_choose(sticks, stiff_t, zero);
        g->rn = reference_choose(closed, -stiff_n * g->gap, -g->normal);
        g->rt = reference_choose(sticks, -stiff_t * g->slip, g->s * g->normal - g->tangent);
        g->push_normal = g->normal + g->rn;
        g->push_tangent = g->tangent + g->rt + g->s * g->rn;
    }
}

static void take_impulses(Reference *r) {
    for (int i = 0; i < r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i];
        const Vec4 by = g->rn - g->dn * g->change_normal;
        const Vec4 tangent = g->tangent + g->rt + g->s * by - g->dt * g->change_tangent;
        g->normal = reference_larger(g->normal + by, reference_all(0));
        g->tangent = reference_clamp(tangent, g->friction * g->normal);
    }
}

double reference_polish(Reference *r, double aim) {
    double miss = reference_miss(r, NULL), before;
    int steps = 0;
    do {
        if (miss <= aim || steps++ == POLISH_MOST) break;
        before = miss;
        guess_states(r);
        reference_factor(r);
        reference_solve_changes(r);
        take_impulses(r);
        reference_apply(r);
        miss = reference_miss(r, NULL);
    } while (miss < 0.5 * before);
    return miss;
}
