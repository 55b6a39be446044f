/* SPDX-License-Identifier: GPL-3.0-or-later */
#pragma once
#include "methods/block_lu.h"
#include "methods/reference.h"

#include <string.h>

/* The linear systems of the reference: with M the masses and J_n, J_t the rows,

       (M + J_n^T D_n J_n + J_t^T (s D_n J_n + D_t J_t)) dv = J^T (impulses of the right-hand side) - M v,

   where v is the change of velocity so far. Impulses then change by dl = r_n - D_n J_n dv and
   dt = r_t + s dl - D_t J_t dv. */
#include "methods/block_lu_code.h"
#include "methods/reference_parts.h"

/* x += J^T impulses, of a group's pairs */
static inline void push(const ReferencePair pairs[REFERENCE_PAIRS], Vec4 normal, Vec4 tangent, Vec4 *x) {
    for (int half = 0, slot = 0; half < REFERENCE_PAIRS; half++, slot += 2) {
        const ReferencePair *pair = &pairs[half];
        const Vec4 force = pair->normal[0] * normal[slot] + pair->tangent[0] * tangent[slot] +
                           pair->normal[1] * normal[slot + 1] + pair->tangent[1] * tangent[slot + 1];
        x[pair->a] += as_body_a(force);
        x[pair->b] += force;
    }
}

static inline Vec4 between(const ReferencePair *pair, const Vec4 *x) {
    const Vec4 a = x[pair->a], b = x[pair->b];
    return (Vec4){b[0] - a[0], b[1] - a[1], b[2], a[2]};
}

/* J_n x and J_t x of a group. Adds up in the order of reference_sum(). */
typedef struct Relative {
    Vec4 normal, tangent;
} Relative;

static inline Relative relative(const ReferenceGroup *g, const ReferencePair pairs[REFERENCE_PAIRS], const Vec4 *x) {
    const Vec4 a = x[pairs[0].a], b = x[pairs[0].b], c = x[pairs[1].a], d = x[pairs[1].b], ab = b - a, cd = d - c;
    const Vec4 along_x = {ab[0], ab[0], cd[0], cd[0]}, along_y = {ab[1], ab[1], cd[1], cd[1]};
    const Vec4 spin_a = {a[2], a[2], c[2], c[2]}, spin_b = {b[2], b[2], d[2], d[2]};
    return (Relative){(g->normal_x * along_x + g->normal_y * along_y) + (g->normal_b * spin_b + g->normal_a * spin_a),
                      (g->normal_y * along_x - g->normal_x * along_y) +
                          (g->tangent_b * spin_b + g->tangent_a * spin_a)};
}

static inline void look_at(ReferenceGroup *g, const ReferencePair pairs[REFERENCE_PAIRS], const Vec4 *moved) {
    const Relative by = relative(g, pairs, moved);
    g->gap = g->free_normal + by.normal;
    g->slip = g->free_tangent + by.tangent;
}

static void look(Reference *r) {
    for (int i = 0; i < r->group_count; i++) look_at(&r->groups[i], &r->pairs[REFERENCE_PAIRS * i], r->moved);
}

static void apply(Reference *r) {
    memset(r->moved, 0, ((size_t)r->lu.count + 1) * sizeof *r->moved);
    for (int i = 0; i < r->group_count; i++)
        push(&r->pairs[REFERENCE_PAIRS * i], r->groups[i].normal, r->groups[i].tangent, r->moved);
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

/* The right-hand side without its impulses, into `changes`. */
static void momentum_left(Reference *r) {
    for (int k = 0; k < r->lu.count; k++) r->changes[k] = -r->masses[k] * r->moved[k];
    r->changes[r->lu.count] = reference_all(0);
}

static void solve_changes(Reference *r) {
    block_lu_solve(&r->lu, r->changes);
    r->changes[r->lu.count] = reference_all(0);
}
