/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An iteration (methods/interior_point_internal.h): first what it does with the contacts of a group, between the
   solves, then with all. Included once by each interior_*.c. The compiler may use wider registers, but not change the
   order of operations. */
#include "methods/block_lu_code.h"
#include "methods/interior_point_internal.h"

#include <math.h>

/* In an iteration l and z keep at least this share of themselves, as do p and q, and the distances of t to its
   bounds. With 0.1 for all three a struck pyramid of 990 boxes takes 2.5 times as long; with 0.2 errors grow by 10%. */
static const double kept = 0.2, kept_slip = 0.11, kept_distance = 0.27;
/* Largest D at the target, as a multiple of the effective mass: the contact is then open by l / m / stiffest. With 1e9
   a pyramid of boxes of unlike masses falls. */
static const double stiffest = 1e12;

static inline Vec4 clamp4(Vec4 x, Vec4 limit) { return larger4(smaller4(x, limit), -limit); }

/* x += J^T impulses, those of the right-hand side. */
static inline void push_right_side(const InteriorGroup *g, const BlockPair pairs[BLOCK_PAIRS], Vec4 *x) {
    block_push(pairs, g->l + g->rn, g->t + g->rt + g->s * g->rn, x);
}

/* The targets of the products, and the impulses that are eliminated: D_n, D_t, s, r_n, r_t. One division for all
   quotients: with the distances u and w of t to its bounds, D_t = u w / (p w + q u). */
static inline void linearise(InteriorGroup *g, double target) {
    const Vec4 softest = all4(1 / stiffest), held = g->friction * g->l;
    g->aim_normal = larger4(target * g->mass_normal, softest * g->l * g->l * g->inverse_normal);
    g->aim_tangent = larger4(target * g->mass_tangent * g->friction, softest * held * held * g->inverse_tangent);
    const Vec4 bound = g->friction * g->l, u = bound - g->t, w = bound + g->t;
    const Vec4 p = g->p * w, q = g->q * u, both = u * w, sum = p + q, all = both * sum;
    const Vec4 over = 1 / (g->z * all), over_both = over * (g->z * sum), over_sum = over * (g->z * both);
    g->over_z = over * all;
    g->upper = over_both * w;
    g->lower = over_both * u;
    g->dn = g->l * g->over_z;
    g->dt = both * over_sum;
    g->s = g->friction * (p - q) * over_sum;
    g->rn = g->aim_normal * g->over_z - g->l - g->dn * (g->normal - g->bias - g->z);
    g->rt = -g->dt * (g->tangent + g->aim_tangent * g->upper - g->aim_tangent * g->lower);
}

/* The changes of a group by a solve, before any limit. */
typedef struct Changes {
    Vec4 l, z, t, p, q;
    Vec4 upper, lower; /* of mu l - t and mu l + t */
} Changes;

static inline Changes changes_of(const InteriorGroup *g, Relative dv, Vec4 second_p, Vec4 second_q) {
    Changes by;
    by.l = g->rn - g->dn * dv.normal;
    by.z = dv.normal + (g->normal - g->bias - g->z);
    by.t = g->rt - g->dt * dv.tangent + g->s * by.l;
    by.upper = g->friction * by.l - by.t;
    by.lower = g->friction * by.l + by.t;
    by.p = (g->aim_tangent + second_p - g->p * by.upper) * g->upper - g->p;
    by.q = (g->aim_tangent + second_q - g->q * by.lower) * g->lower - g->q;
    return by;
}

static inline Vec4 square(Vec4 x) { return x * x; }

static inline Vec4 squared_residual(const InteriorGroup *g) {
    const Vec4 bound = g->friction * g->answer_normal;
    const Vec4 wanted = clamp4(g->answer_tangent - g->mass_tangent * g->tangent, bound);
    return square(smaller4(g->answer_normal * g->inverse_normal, g->normal - g->bias)) +
           square((g->answer_tangent - wanted) * g->inverse_tangent);
}

/* x = M (v' - v) */
static void momentum_left(const Interior *s, Vec4 *x) {
    for (int k = 0; k < s->graph.lu.count; k++) x[k] = s->graph.masses[k] * (s->start[k] - s->velocities[k]);
    x[s->graph.lu.count] = all4(0);
}

/* The pair's J^T D J in its own coordinates, by columns. The first two rows of J are those of the normal, for both
   contacts. */
static inline void stiffness(const InteriorGroup *g, const BlockPair *pair, int slot, Vec4 columns[4]) {
    const Vec4 *n = pair->normal, *t = pair->tangent;
    const Vec4 along[2] = {(n[0] + t[0] * g->s[slot]) * g->dn[slot], (n[1] + t[1] * g->s[slot + 1]) * g->dn[slot + 1]};
    const Vec4 across[2] = {t[0] * g->dt[slot], t[1] * g->dt[slot + 1]};
    const Vec4 both_along = along[0] + along[1], both_across = across[0] + across[1];
    const double x = g->rows.normal_x[slot], y = g->rows.normal_y[slot];
    columns[0] = both_along * x + both_across * y;
    columns[1] = both_along * y - both_across * x;
    columns[2] = (along[0] * g->rows.normal_b[slot] + across[0] * g->rows.tangent_b[slot]) +
                 (along[1] * g->rows.normal_b[slot + 1] + across[1] * g->rows.tangent_b[slot + 1]);
    columns[3] = (along[0] * g->rows.normal_a[slot] + across[0] * g->rows.tangent_a[slot]) +
                 (along[1] * g->rows.normal_a[slot + 1] + across[1] * g->rows.tangent_a[slot + 1]);
}

/* The matrix and the right-hand side. */
static void assemble(Interior *s, double target, Vec4 *right) {
    begin_blocks(&s->graph);
    momentum_left(s, right);
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        const BlockPair *pairs = &s->pairs[BLOCK_PAIRS * i];
        linearise(g, target);
        push_right_side(g, pairs, right);
        for (int half = 0; half < BLOCK_PAIRS; half++) {
            Vec4 columns[4];
            stiffness(g, &pairs[half], 2 * half, columns);
            block_add_pair(s->graph.lu.blocks, pairs[half].a, pairs[half].b, pairs[half].place, columns);
        }
    }
}

/* The products of second order that the first solve predicts, limited to the size of the terms themselves. */
static void correct(Interior *s, const Vec4 *x, Vec4 *right) {
    momentum_left(s, right);
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        const BlockPair *pairs = &s->pairs[BLOCK_PAIRS * i];
        const Changes by = changes_of(g, relative(&g->rows, pairs, x), all4(0), all4(0));
        const Vec4 bound = g->friction * g->l;
        g->rn -= clamp4(by.l * by.z, larger4(g->aim_normal, g->l * g->z)) * g->over_z;
        g->second_p = -clamp4(by.p * by.upper, larger4(g->aim_tangent, g->p * (bound - g->t)));
        g->second_q = -clamp4(by.q * by.lower, larger4(g->aim_tangent, g->q * (bound + g->t)));
        g->rt -= g->dt * (g->second_p * g->upper - g->second_q * g->lower);
        push_right_side(g, pairs, right);
    }
}

static double mean_root(const Interior *s, Vec4 sum) {
    return s->contact_count > 0 ? sqrt(sum4(sum) / s->contact_count) : 0;
}

/* The next iterate, and the answer: the full step, inside the cone. Returns the answer's residual at the velocities of
   the full step, with the changes by the projection. */
static double advance(Interior *s, const Vec4 *x) {
    Vec4 sum = all4(0);
    for (int k = 0; k < s->graph.lu.count; k++) s->velocities[k] += x[k];
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        const Relative dv = relative(&g->rows, &s->pairs[BLOCK_PAIRS * i], x);
        const Changes by = changes_of(g, dv, g->second_p, g->second_q);
        const Vec4 full_l = g->l + by.l, full_t = g->t + by.t;
        g->answer_normal = larger4(full_l, all4(0));
        g->answer_tangent = clamp4(full_t, g->friction * g->answer_normal);
        /* The iterate stays inside all bounds. */
        const Vec4 l = larger4(full_l, kept * g->l), bound = g->friction * l, before = g->friction * g->l;
        const Vec4 share = 1 - kept_distance * (1 - larger4(g->t, -g->t) / before);
        g->t = clamp4(full_t, smaller4(share, all4(1 - 1e-13)) * bound);
        g->l = l;
        g->z = larger4(g->z + by.z, kept * g->z);
        g->p = larger4(g->p + by.p, kept_slip * g->p);
        g->q = larger4(g->q + by.q, kept_slip * g->q);
        g->normal += dv.normal;
        g->tangent += dv.tangent;
        sum += squared_residual(g) + square((full_l - g->answer_normal) * g->inverse_normal) +
               square((full_t - g->answer_tangent) * g->inverse_tangent);
    }
    return mean_root(s, sum);
}

static void solve_changes(const Interior *s, Vec4 *x) {
    block_lu_solve(&s->graph.lu, x);
    x[s->graph.lu.count] = all4(0);
}

static double iterate(Interior *s, double target) {
    assemble(s, target, s->changes);
    block_lu_factor(&s->graph.lu);
    solve_changes(s, s->changes);
    correct(s, s->changes, s->corrected);
    solve_changes(s, s->corrected);
    return advance(s, s->corrected);
}

static double answer(Interior *s) {
    Vec4 *x = s->changes, sum = all4(0);
    for (int k = 0; k <= s->graph.lu.count; k++) x[k] = all4(0);
    for (int i = 0; i < s->group_count; i++)
        block_push(&s->pairs[BLOCK_PAIRS * i], s->groups[i].answer_normal, s->groups[i].answer_tangent, x);
    for (int k = 0; k <= s->graph.lu.count; k++) {
        x[k] *= s->graph.inverses[k];
        s->velocities[k] = s->start[k] + x[k];
    }
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        const Relative dv = relative(&g->rows, &s->pairs[BLOCK_PAIRS * i], x);
        g->normal = g->free_normal + dv.normal;
        g->tangent = g->free_tangent + dv.tangent;
        sum += squared_residual(g);
    }
    return mean_root(s, sum);
}

const InteriorKernels KERNELS = {KERNELS_NAME, block_lu_factor, block_lu_solve, iterate, answer};
