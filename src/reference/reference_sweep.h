/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include "reference/reference_newton.h"

static double clamp(double x, double limit) { return x > limit ? limit : x < -limit ? -limit : x; }
static double larger(double x, double y) { return x > y ? x : y; }

/* One contact: first its normal impulse, then its tangent impulse. Returns the larger change. */
static double visit(Reference *r, const ReferencePair *pair, ReferenceGroup *g, int slot) {
    Vec4 *a = &r->moved[pair->a], *b = &r->moved[pair->b];
    const int k = slot % 2;
    const double gap = g->free_normal[slot] + reference_sum(pair->normal[k] * between(pair, r->moved));
    const double normal = larger(g->normal[slot] - g->mass_normal[slot] * gap, 0), dn = normal - g->normal[slot];
    *a += r->inverses[pair->a] * as_body_a(pair->normal[k] * reference_all(dn));
    *b += r->inverses[pair->b] * (pair->normal[k] * reference_all(dn));
    const double slip = g->free_tangent[slot] + reference_sum(pair->tangent[k] * between(pair, r->moved));
    const double tangent = clamp(g->tangent[slot] - g->mass_tangent[slot] * slip, g->friction[slot] * normal);
    const double dt = tangent - g->tangent[slot];
    *a += r->inverses[pair->a] * as_body_a(pair->tangent[k] * reference_all(dt));
    *b += r->inverses[pair->b] * (pair->tangent[k] * reference_all(dt));
    g->normal[slot] = normal;
    g->tangent[slot] = tangent;
    return larger(fabs(dn) * g->inverse_normal[slot], fabs(dt) * g->inverse_tangent[slot]);
}

static double sweep(Reference *r) {
    double most = 0;
    for (int i = 0; i < r->pair_count; i++)
        for (int k = 0; k < r->pairs[i].count; k++) {
            ReferenceGroup *group = &r->groups[i / REFERENCE_PAIRS];
            const int slot = i % REFERENCE_PAIRS * 2 + k;
            if (!(group->weight[slot] > 0)) continue;
            const double change = visit(r, &r->pairs[i], group, slot);
            most = change > most || isnan(change) ? change : most;
        }
    return most;
}
