/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The linear systems of the reference: with M the masses and J_n, J_t the rows,

       (M + J_n^T D_n J_n + J_t^T (s D_n J_n + D_t J_t)) dv = J^T (impulses of the right-hand side) - M v,

   where v is the change of velocity so far. Impulses then change by dl = r_n - D_n J_n dv and
   dt = r_t + s dl - D_t J_t dv. */
#pragma once
#include "interior/block_lu_code.h"
#include "reference/reference_parts.h"
#include <string.h>

static void push(const Reference *r, bool answer, Vec4 *x) {
    for (int i = 0; i < REFERENCE_PAIRS * r->group_count; i++) {
        const ReferenceGroup *g = &r->groups[i / REFERENCE_PAIRS];
        const ReferencePair *pair = &r->pairs[i];
        const double *normal = (const double *)(answer ? &g->normal : &g->push_normal) + i % REFERENCE_PAIRS * 2;
        const double *tangent = (const double *)(answer ? &g->tangent : &g->push_tangent) + i % REFERENCE_PAIRS * 2;
        const Vec4 force = pair->normal[0] * normal[0] + pair->tangent[0] * tangent[0] + pair->normal[1] * normal[1] +
                           pair->tangent[1] * tangent[1];
        x[pair->a] += as_body_a(force);
        x[pair->b] += force;
    }
}

static inline Vec4 between(const ReferencePair *pair, const Vec4 *x) {
    const Vec4 a = x[pair->a], b = x[pair->b];
    return (Vec4){b[0] - a[0], b[1] - a[1], b[2], a[2]};
}

static void look(Reference *r) {
    for (int i = 0; i < REFERENCE_PAIRS * r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i / REFERENCE_PAIRS];
        const Vec4 by = between(&r->pairs[i], r->moved);
        for (int k = 0, slot = i % REFERENCE_PAIRS * 2; k < 2; k++, slot++) {
            g->gap[slot] = g->free_normal[slot] + reference_sum(r->pairs[i].normal[k] * by);
            g->slip[slot] = g->free_tangent[slot] + reference_sum(r->pairs[i].tangent[k] * by);
        }
    }
}

static void apply(Reference *r) {
    memset(r->moved, 0, ((size_t)r->lu.count + 1) * sizeof *r->moved);
    push(r, true, r->moved);
    for (int k = 0; k <= r->lu.count; k++) r->moved[k] *= r->inverses[k];
    look(r);
}

static inline Vec4 magnitude(Vec4 x) { return reference_larger(x, -x); }

static double missed(Reference *r, double *rms) {
    Vec4 most = reference_all(0), sum = reference_all(0);
    for (int i = 0; i < r->group_count; i++) {
        const ReferenceGroup *g = &r->groups[i];
        const Vec4 close = g->normal * g->inverse_normal;
        const Vec4 normal = magnitude(g->weight * reference_choose((ReferenceMask)(close < g->gap), close, g->gap));
        const Vec4 wanted = reference_clamp(g->tangent - g->mass_tangent * g->slip, g->friction * g->normal);
        const Vec4 tangent = magnitude(g->weight * (g->tangent - wanted) * g->inverse_tangent);
        most = reference_larger(normal, reference_larger(tangent, most));
        sum += normal * normal + tangent * tangent;
    }
    double largest = 0;
    for (int k = 0; k < REFERENCE_SLOTS; k++) largest = most[k] > largest ? most[k] : largest;
    const double total = reference_sum(sum);
    if (rms != NULL) *rms = r->contact_count > 0 ? sqrt(total / r->contact_count) : 0;
    return isnan(total) ? (double)NAN : largest;
}

/* The pair's J^T D J in its own coordinates, by columns. */
static inline void stiffness(const ReferenceGroup *g, const ReferencePair *pair, int slot, Vec4 columns[4]) {
    for (int c = 0; c < 4; c++) columns[c] = reference_all(0);
    for (int k = 0; k < 2; k++) {
        const Vec4 along = (pair->normal[k] + pair->tangent[k] * g->s[slot + k]) * g->dn[slot + k];
        const Vec4 across = pair->tangent[k] * g->dt[slot + k];
        const double *n = (const double *)&pair->normal[k], *t = (const double *)&pair->tangent[k];
        for (int c = 0; c < 4; c++) columns[c] += along * n[c] + across * t[c];
    }
}

static void factor_matrix(Reference *r) {
    BlockLu *lu = &r->lu;
    for (int k = 0; k < lu->count; k++) {
        const Vec4 m = r->masses[k];
        lu->blocks[k] = (Block3){{{m[0], 0, 0, 0}, {0, m[1], 0, 0}, {0, 0, m[2], 0}}};
    }
    memset(lu->blocks + lu->count, 0, (2 * (size_t)lu->below + 3) * sizeof *lu->blocks);
    for (int i = 0; i < REFERENCE_PAIRS * r->group_count; i++) {
        Vec4 columns[4];
        stiffness(&r->groups[i / REFERENCE_PAIRS], &r->pairs[i], i % REFERENCE_PAIRS * 2, columns);
        block_add_pair(lu->blocks, r->pairs[i].a, r->pairs[i].b, r->pairs[i].place, columns);
    }
    block_lu_factor(lu);
    r->factorizations++;
}

static void solve_changes(Reference *r) {
    const int count = r->lu.count;
    for (int k = 0; k < count; k++) r->changes[k] = -r->masses[k] * r->moved[k];
    push(r, false, r->changes);
    block_lu_solve(&r->lu, r->changes);
    r->changes[count] = reference_all(0);
    for (int i = 0; i < REFERENCE_PAIRS * r->group_count; i++) {
        ReferenceGroup *g = &r->groups[i / REFERENCE_PAIRS];
        const Vec4 by = between(&r->pairs[i], r->changes);
        for (int k = 0, slot = i % REFERENCE_PAIRS * 2; k < 2; k++, slot++) {
            g->change_normal[slot] = reference_sum(r->pairs[i].normal[k] * by);
            g->change_tangent[slot] = reference_sum(r->pairs[i].tangent[k] * by);
        }
    }
}
