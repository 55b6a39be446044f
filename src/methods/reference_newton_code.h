/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The linear systems of the reference: with M the masses and J_n, J_t the rows,

       (M + J_n^T D_n J_n + J_t^T (s D_n J_n + D_t J_t)) dv = J^T (impulses of the right-hand side) - M v,

   where v is the change of velocity so far. Impulses then change by dl = r_n - D_n J_n dv and
   dt = r_t + s dl - D_t J_t dv. */
#pragma once
#include "methods/block_lu.h"
#include "methods/block_lu_code.h"
#include "methods/reference.h"
#include "methods/reference_parts.h"

#include <string.h>

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
