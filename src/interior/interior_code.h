/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of the iterations; included once by each interior_*.c. The compiler may use wider registers, but not
   change the order of operations. */
#include "interior/block_lu_code.h"
#include "interior/interior_contacts.h"

#include <math.h>

/* x = M (v' - v) */
static void momentum_left(const Interior *s, Vec4 *x) {
    for (int k = 0; k < s->lu.count; k++) x[k] = s->masses[k] * (s->start[k] - s->velocities[k]);
    x[s->lu.count] = all4(0);
}

/* x += J^T impulses */
static inline void push(const InteriorPair pairs[GROUP_PAIRS], Impulses by, Vec4 *x) {
    for (int half = 0, slot = 0; half < GROUP_PAIRS; half++, slot += 2) {
        const InteriorPair *pair = &pairs[half];
        const Vec4 force = (pair->normal[0] * by.normal[slot] + pair->tangent[0] * by.tangent[slot]) +
                           (pair->normal[1] * by.normal[slot + 1] + pair->tangent[1] * by.tangent[slot + 1]);
        x[pair->a] += as_body_a(force);
        x[pair->b] += force;
    }
}

/* The pair's J^T D J in its own coordinates, by columns. The first two rows of J are those of the normal, for both
   contacts. */
static inline void stiffness(const InteriorGroup *g, const InteriorPair *pair, int slot, Vec4 columns[4]) {
    const Vec4 *n = pair->normal, *t = pair->tangent;
    const Vec4 along[2] = {(n[0] + t[0] * g->s[slot]) * g->dn[slot], (n[1] + t[1] * g->s[slot + 1]) * g->dn[slot + 1]};
    const Vec4 across[2] = {t[0] * g->dt[slot], t[1] * g->dt[slot + 1]};
    const Vec4 both_along = along[0] + along[1], both_across = across[0] + across[1];
    const double x = g->normal_x[slot], y = g->normal_y[slot];
    columns[0] = both_along * x + both_across * y;
    columns[1] = both_along * y - both_across * x;
    columns[2] = (along[0] * g->normal_b[slot] + across[0] * g->tangent_b[slot]) +
                 (along[1] * g->normal_b[slot + 1] + across[1] * g->tangent_b[slot + 1]);
    columns[3] = (along[0] * g->normal_a[slot] + across[0] * g->tangent_a[slot]) +
                 (along[1] * g->normal_a[slot + 1] + across[1] * g->tangent_a[slot + 1]);
}

/* The masses, and zeros elsewhere. */
static void begin_blocks(const Interior *s, BlockLu *lu) {
    for (int k = 0; k < lu->count; k++) {
        const Vec4 m = s->masses[k];
        lu->blocks[k] = (Block3){{vec4(m[0], 0, 0, 0), vec4(0, m[1], 0, 0), vec4(0, 0, m[2], 0)}};
    }
    const Block3 zero = {{all4(0), all4(0), all4(0)}};
    for (int i = lu->count; i < lu->count + 2 * lu->below + 3; i++) lu->blocks[i] = zero;
}

/* The matrix and the right-hand side. */
static void assemble(Interior *s, double target, Vec4 *right) {
    begin_blocks(s, &s->lu);
    momentum_left(s, right);
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        const InteriorPair *pairs = &s->pairs[GROUP_PAIRS * i];
        aim(g, target);
        linearise(g);
        push(pairs, right_side(g), right);
        for (int half = 0; half < GROUP_PAIRS; half++) {
            Vec4 columns[4];
            stiffness(g, &pairs[half], 2 * half, columns);
            block_add_pair(s->lu.blocks, pairs[half].a, pairs[half].b, pairs[half].place, columns);
        }
    }
}

static inline Relative relative(const InteriorGroup *g, const InteriorPair pairs[GROUP_PAIRS], const Vec4 *x) {
    const Vec4 a = x[pairs[0].a], b = x[pairs[0].b], c = x[pairs[1].a], d = x[pairs[1].b], ab = b - a, cd = d - c;
    const Vec4 along_x = vec4(ab[0], ab[0], cd[0], cd[0]), along_y = vec4(ab[1], ab[1], cd[1], cd[1]);
    const Vec4 spin_a = vec4(a[2], a[2], c[2], c[2]), spin_b = vec4(b[2], b[2], d[2], d[2]);
    return (Relative){(g->normal_x * along_x + g->normal_y * along_y) + (g->normal_b * spin_b + g->normal_a * spin_a),
                      (g->normal_y * along_x - g->normal_x * along_y) +
                          (g->tangent_b * spin_b + g->tangent_a * spin_a)};
}

static void correct_all(Interior *s, const Vec4 *x, Vec4 *right) {
    momentum_left(s, right);
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        const InteriorPair *pairs = &s->pairs[GROUP_PAIRS * i];
        correct(g, relative(g, pairs, x));
        push(pairs, right_side(g), right);
    }
}

static double mean_root(const Interior *s, Vec4 sum) {
    return s->contact_count > 0 ? sqrt(sum4(sum) / s->contact_count) : 0;
}

static double advance_all(Interior *s, const Vec4 *x) {
    Vec4 sum = all4(0);
    for (int k = 0; k < s->lu.count; k++) s->velocities[k] += x[k];
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        sum += advance(g, relative(g, &s->pairs[GROUP_PAIRS * i], x));
    }
    return mean_root(s, sum);
}

static void solve_changes(const Interior *s, Vec4 *x) {
    block_lu_solve(&s->lu, x);
    x[s->lu.count] = all4(0);
}

static double iterate(Interior *s, double target) {
    assemble(s, target, s->changes);
    block_lu_factor(&s->lu);
    solve_changes(s, s->changes);
    correct_all(s, s->changes, s->corrected);
    solve_changes(s, s->corrected);
    return advance_all(s, s->corrected);
}

static double answer(Interior *s) {
    Vec4 *x = s->changes, sum = all4(0);
    for (int k = 0; k <= s->lu.count; k++) x[k] = all4(0);
    for (int i = 0; i < s->group_count; i++)
        push(&s->pairs[GROUP_PAIRS * i], (Impulses){s->groups[i].answer_normal, s->groups[i].answer_tangent}, x);
    for (int k = 0; k <= s->lu.count; k++) {
        x[k] *= s->inverses[k];
        s->velocities[k] = s->start[k] + x[k];
    }
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        const Relative dv = relative(g, &s->pairs[GROUP_PAIRS * i], x);
        g->normal = g->free_normal + dv.normal;
        g->tangent = g->free_tangent + dv.tangent;
        sum += squared_residual(g);
    }
    return mean_root(s, sum);
}

const InteriorKernels KERNELS = {KERNELS_NAME, block_lu_factor, block_lu_solve, iterate, answer};
