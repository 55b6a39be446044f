/* SPDX-License-Identifier: GPL-3.0-or-later */
/* An iteration of ADMM (methods/admm_internal.h). Included once by each admm_*.c. The compiler may use wider registers,
   but not change the order of operations. */
#include "methods/admm_internal.h"
#include "methods/block_lu_code.h"

#include <math.h>

enum { POWER_STEPS = 3 };

static inline Vec4 size4(Vec4 x) { return larger4(x, -x); }

/* y: the point of the cone |tangent| <= friction normal that is nearest to (normal, tangent). */
static inline void project(AdmmGroup *g, Vec4 normal, Vec4 tangent) {
    const Vec4 bound = g->friction * normal, along = size4(tangent);
    const Vec4 edge = larger4((normal + g->friction * along) / (1 + g->friction * g->friction), all4(0));
    const Mask4 inside = (Mask4)(along <= bound), forward = (Mask4)(tangent >= 0);
    g->y_normal = choose4(inside, normal, edge);
    g->y_tangent = choose4(inside, tangent, choose4(forward, g->friction * edge, -g->friction * edge));
}

/* Adds J^T of scaled impulses to target. */
static inline void push(const AdmmGroup *g, const BlockPair pairs[BLOCK_PAIRS], Vec4 normal, Vec4 tangent,
                        Vec4 *target) {
    block_push(pairs, g->root_normal * normal, g->root_tangent * tangent, target);
}

static void factorize(Admm *admm) {
    BlockGraph *graph = &admm->interior.graph;
    const double over = 1 / (admm->penalty + admm_proximal);
    begin_blocks(graph);
    for (int i = 0; i < admm->interior.group_count; i++) {
        for (int half = 0; half < BLOCK_PAIRS; half++) {
            const BlockPair *pair = &admm->interior.pairs[BLOCK_PAIRS * i + half];
            const AdmmGroup *g = &admm->groups[i];
            Vec4 columns[4]; /* J^T J of scaled rows, over D */
            block_stiffness(pair, 2 * half, g->root_normal * g->root_normal * over,
                            g->root_tangent * g->root_tangent * over, all4(0), columns);
            block_add_pair(graph->lu.blocks, pair->a, pair->b, pair->place, columns);
        }
    }
    block_lu_factor(&graph->lu);
}

static inline Vec4 root4(Vec4 x) { return vec4(sqrt(x[0]), sqrt(x[1]), sqrt(x[2]), sqrt(x[3])); }

static inline void begin_group(AdmmGroup *g, const InteriorGroup *from) {
    g->root_normal = root4(from->mass_normal);
    g->root_tangent = root4(from->mass_tangent);
    g->friction = from->friction * g->root_normal / g->root_tangent;
    g->g_normal = g->root_normal * (from->free_normal - from->bias);
    g->g_tangent = g->root_tangent * from->free_tangent;
    /* The dual cone's nearest point to z is z and the cone's nearest point to -z (Moreau). */
    g->z_tangent = g->g_tangent;
    g->z_normal = g->g_normal + g->friction * size4(g->g_tangent);
    project(g, -g->z_normal, -g->z_tangent);
    g->z_normal += g->y_normal;
    g->z_tangent += g->y_tangent;
    project(g, from->answer_normal / g->root_normal, from->answer_tangent / g->root_tangent);
    g->x_normal = g->y_normal;
    g->x_tangent = g->y_tangent;
}

static double largest4(Vec4 x) { return fmax(fmax(x[0], x[1]), fmax(x[2], x[3])); }

static void begin(Admm *admm) {
    Vec4 velocity = all4(0);
    for (int i = 0; i < admm->interior.group_count; i++) {
        AdmmGroup *g = &admm->groups[i];
        begin_group(g, &admm->interior.groups[i]);
        velocity = larger4(larger4(size4(g->g_normal), size4(g->g_tangent)), velocity);
    }
    admm->largest_g = largest4(velocity);
}

/* The next q, and what J^T makes of it. */
static inline void prepare(AdmmGroup *g, double r) {
    const Vec4 slip = g->friction * size4(g->z_tangent);
    g->q_normal = g->z_normal + r * g->y_normal + admm_proximal * g->x_normal - g->g_normal - slip;
    g->q_tangent = g->z_tangent + r * g->y_tangent + admm_proximal * g->x_tangent - g->g_tangent;
}

/* x, y and z from the velocities jw = J w. Adds to the largest residuals. */
static inline void advance(AdmmGroup *g, double r, Relative jw, Vec4 *primal, Vec4 *dual) {
    const double over = 1 / (r + admm_proximal), over_r = 1 / r;
    const Vec4 x_normal = g->x_normal, x_tangent = g->x_tangent, y_normal = g->y_normal, y_tangent = g->y_tangent;
    g->x_normal = (g->q_normal - g->root_normal * jw.normal) * over;
    g->x_tangent = (g->q_tangent - g->root_tangent * jw.tangent) * over;
    project(g, g->x_normal - g->z_normal * over_r, g->x_tangent - g->z_tangent * over_r);
    const Vec4 apart_normal = g->x_normal - g->y_normal, apart_tangent = g->x_tangent - g->y_tangent;
    g->z_normal -= r * apart_normal;
    g->z_tangent -= r * apart_tangent;
    *primal = larger4(larger4(size4(apart_normal), size4(apart_tangent)), *primal);
    const Vec4 moved_normal = r * (g->y_normal - y_normal) + admm_proximal * (g->x_normal - x_normal);
    const Vec4 moved_tangent = r * (g->y_tangent - y_tangent) + admm_proximal * (g->x_tangent - x_tangent);
    *dual = larger4(larger4(size4(moved_normal), size4(moved_tangent)), *dual);
}

static void iterate(Admm *admm) {
    Interior *s = &admm->interior;
    Vec4 *w = s->changes, primal = all4(0), dual = all4(0);
    const double over = 1 / (admm->penalty + admm_proximal);
    for (int k = 0; k <= s->graph.lu.count; k++) w[k] = all4(0);
    for (int i = 0; i < s->group_count; i++) {
        AdmmGroup *g = &admm->groups[i];
        prepare(g, admm->penalty);
        push(g, &s->pairs[BLOCK_PAIRS * i], g->q_normal * over, g->q_tangent * over, w);
    }
    block_lu_solve(&s->graph.lu, w);
    w[s->graph.lu.count] = all4(0);
    for (int i = 0; i < s->group_count; i++)
        advance(&admm->groups[i], admm->penalty, relative(&s->groups[i].rows, &s->pairs[BLOCK_PAIRS * i], w), &primal,
                &dual);
    admm->primal = largest4(primal);
    admm->dual = largest4(dual);
}

/* An estimate of the largest eigenvalue of G, by the power method from a vector of ones: at least its mean, 1. */
static double largest(Admm *admm) {
    Interior *s = &admm->interior;
    double before = 0, after = 0;
    for (int i = 0; i < s->group_count; i++) admm->groups[i].q_normal = admm->groups[i].q_tangent = all4(1);
    for (int step = 0; step < POWER_STEPS; step++) {
        Vec4 *w = s->changes, sum = all4(0);
        before = after;
        for (int k = 0; k <= s->graph.lu.count; k++) w[k] = all4(0);
        for (int i = 0; i < s->group_count; i++) {
            const AdmmGroup *g = &admm->groups[i];
            push(g, &s->pairs[BLOCK_PAIRS * i], g->q_normal, g->q_tangent, w);
        }
        for (int k = 0; k <= s->graph.lu.count; k++) w[k] *= s->graph.inverses[k];
        for (int i = 0; i < s->group_count; i++) {
            AdmmGroup *g = &admm->groups[i];
            const Relative jw = relative(&s->groups[i].rows, &s->pairs[BLOCK_PAIRS * i], w);
            g->q_normal = g->root_normal * jw.normal;
            g->q_tangent = g->root_tangent * jw.tangent;
            sum += g->q_normal * g->q_normal + g->q_tangent * g->q_tangent;
        }
        after = sqrt(sum4(sum));
    }
    const double ratio = after / before; /* NaN without contacts */
    return ratio > 1 ? ratio : 1;
}

const AdmmKernels KERNELS = {KERNELS_NAME, begin, largest, factorize, iterate};
