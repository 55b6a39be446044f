/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The numbers of the iterations; included once by each interior_*.c. The compiler may use wider registers, but not
   change the order of operations. */
#include "interior/block_lu_code.h"
#include "interior/interior.h"

#include <math.h>

typedef long long Mask4 __attribute__((vector_size(32), aligned(16), may_alias));

static inline Vec4 choose(Mask4 mask, Vec4 x, Vec4 y) { return (Vec4)((mask & (Mask4)x) | (~mask & (Mask4)y)); }
static inline Vec4 smaller(Vec4 x, Vec4 y) { return choose((Mask4)(x < y), x, y); }
static inline Vec4 larger(Vec4 x, Vec4 y) { return choose((Mask4)(x > y), x, y); }
static inline Vec4 clamp4(Vec4 x, Vec4 limit) { return larger(smaller(x, limit), -limit); }
static inline Vec4 magnitude(Vec4 x) { return larger(x, -x); }
static inline Vec4 all4(double x) { return (Vec4){x, x, x, x}; }
static inline double sum4(Vec4 x) { return (x[0] + x[1]) + (x[2] + x[3]); }

/* Impulses, slips and distances to the bounds keep at least this share of themselves in an iteration. */
static const double kept = 0.15;
/* Largest D at the target, as a multiple of the effective mass: the contact is then open by l / m / stiffest. */
static const double stiffest = 1e12;

typedef unsigned long long Bits4 __attribute__((vector_size(32), aligned(16), may_alias));

/* interior_net_log2() and interior_net_power2() of four numbers. */
static inline Vec4 log2_4(Vec4 x) {
    const Bits4 two52 = (Bits4)all4(0x1p52);
    return ((Vec4)((Bits4)x >> 12 | two52) - 0x1p52) * 0x1p-40 - 1023;
}
static inline Vec4 power2_4(Vec4 x) { return (Vec4)((Bits4)((x + 1023) * 0x1p40 + 0x1p52) << 12); }

/* The network's factors of l, z and the target for a group. scale: log2 tau */
static inline void consult_group(InteriorGroup *g, const double *weights, const double *hidden_biases,
                                 const double *output_biases, double scale) {
    const Vec4 gap = (g->normal - g->bias) / g->z - 1;
    const Vec4 inputs[INTERIOR_NET_INPUTS] = {(log2_4(g->l * g->inverse_normal) - scale) * 0.25,
                                              (log2_4(g->z) - scale) * 0.25, clamp4(gap, all4(INTERIOR_NET_GAP))};
    Vec4 hidden[INTERIOR_NET_HIDDEN], factors[INTERIOR_NET_OUTPUTS];
    const double *by = weights + INTERIOR_NET_HIDDEN_WEIGHTS;
    for (int i = 0; i < INTERIOR_NET_HIDDEN; i++, by += INTERIOR_NET_INPUTS) {
        Vec4 sum = all4(hidden_biases[i]);
        for (int k = 0; k < INTERIOR_NET_INPUTS; k++) sum += inputs[k] * by[k];
        hidden[i] = larger(sum, sum * INTERIOR_NET_LEAK);
    }
    by = weights + INTERIOR_NET_OUTPUT_WEIGHTS;
    for (int i = 0; i < INTERIOR_NET_OUTPUTS; i++, by += INTERIOR_NET_HIDDEN) {
        Vec4 sum = all4(output_biases[i]);
        for (int k = 0; k < INTERIOR_NET_HIDDEN; k++) sum += hidden[k] * by[k];
        factors[i] = power2_4(clamp4(sum, all4(INTERIOR_NET_LIMIT)));
    }
    g->l *= factors[0];
    g->t *= factors[0];
    g->z *= factors[1];
    g->aim = factors[2];
}

static void consult(Interior *s, double target) {
    const double *weights = s->net->weights;
    const double scale = 0.5 * interior_net_log2(target);
    for (int i = 0; i < s->group_count; i++)
        consult_group(&s->groups[i], weights,
                      weights + INTERIOR_NET_HIDDEN_BIASES + (ptrdiff_t)INTERIOR_NET_HIDDEN * s->iterations,
                      weights + INTERIOR_NET_OUTPUT_BIASES + (ptrdiff_t)INTERIOR_NET_OUTPUTS * s->iterations, scale);
}

static void stop_consulting(Interior *s) {
    for (int i = 0; i < s->group_count; i++) s->groups[i].aim = all4(1);
}

/* Impulses that are eliminated: D_n, D_t, s, r_n, r_t. */
static void linearise(Interior *s, double target) {
    const Vec4 tau2 = all4(target), softest = all4(1 / stiffest);
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        const Vec4 bound = g->friction * g->l;
        g->over_z = 1 / g->z;
        g->aim_normal = larger(tau2 * g->aim * g->mass_normal, softest * g->l * g->l * g->inverse_normal);
        g->aim_tangent = larger(tau2 * g->mass_tangent * g->friction, softest * bound * bound * g->inverse_tangent);
        g->dn = g->l * g->over_z;
        g->rn = g->aim_normal * g->over_z - g->l - g->dn * (g->normal - g->bias - g->z);
        g->upper = 1 / (bound - g->t);
        g->lower = 1 / (bound + g->t);
        const Vec4 p = g->p * g->upper, q = g->q * g->lower;
        g->dt = 1 / (p + q);
        g->s = g->friction * (p - q) * g->dt;
        g->rt = -g->dt * (g->tangent + g->aim_tangent * g->upper - g->aim_tangent * g->lower);
        g->impulse_normal = g->l + g->rn;
        g->impulse_tangent = g->t + g->rt + g->s * g->rn;
    }
}

static inline Vec4 signs(void) { return vec4(-1, -1, 1, 1); }
static inline Vec4 as_body_a(Vec4 x) { return vec4(x[0], x[1], x[3], x[2]) * signs(); }

/* M (v' - v) */
static void momentum_left(const Interior *s, Vec4 *x) {
    for (int k = 0; k < s->lu.count; k++) x[k] = s->masses[k] * (s->start[k] - s->velocities[k]);
    x[s->lu.count] = all4(0);
}

/* x += J^T of the impulses of the right-hand side */
static inline void push_pair(const InteriorGroup *g, const InteriorPair *pair, int slot, Vec4 *x) {
    const Vec4 force = pair->normal[0] * g->impulse_normal[slot] + pair->tangent[0] * g->impulse_tangent[slot] +
                       pair->normal[1] * g->impulse_normal[slot + 1] + pair->tangent[1] * g->impulse_tangent[slot + 1];
    x[pair->a] += as_body_a(force);
    x[pair->b] += force;
}

static void push_all(const Interior *s, Vec4 *x) {
    for (int i = 0; i < s->group_count; i++)
        for (int half = 0; half < GROUP_PAIRS; half++)
            push_pair(&s->groups[i], &s->pairs[GROUP_PAIRS * i + half], 2 * half, x);
}

/* The pair's J^T D J in its own coordinates, by columns. */
static inline void stiffness(const InteriorGroup *g, const InteriorPair *pair, int slot, Vec4 columns[4]) {
    for (int c = 0; c < 4; c++) columns[c] = all4(0);
    for (int k = 0; k < 2; k++) {
        const Vec4 along = (pair->normal[k] + pair->tangent[k] * g->s[slot + k]) * g->dn[slot + k];
        const Vec4 across = pair->tangent[k] * g->dt[slot + k];
        const double *n = (const double *)&pair->normal[k], *t = (const double *)&pair->tangent[k];
        for (int c = 0; c < 4; c++) columns[c] += along * n[c] + across * t[c];
    }
}

/* Adds the pair to the blocks of its bodies. Coordinates of body a: minus the linear velocity, spin of a. */
static inline void add_stiffness(Block3 *blocks, const InteriorPair *pair, const Vec4 columns[4]) {
    Block3 *aa = &blocks[pair->a], *bb = &blocks[pair->b];
    Block3 *ab = &blocks[pair->place.row_a], *ba = &blocks[pair->place.row_b];
    for (int c = 0; c < 2; c++) {
        const Vec4 of_a = as_body_a(columns[c]);
        bb->column[c] += columns[c];
        ba->column[c] -= columns[c];
        ab->column[c] += of_a;
        aa->column[c] -= of_a;
    }
    bb->column[2] += columns[2];
    ba->column[2] += columns[3];
    ab->column[2] += as_body_a(columns[2]);
    aa->column[2] += as_body_a(columns[3]);
}

static void assemble(Interior *s) {
    BlockLu *lu = &s->lu;
    for (int k = 0; k < lu->count; k++) {
        const Vec4 m = s->masses[k];
        lu->blocks[k] = (Block3){{vec4(m[0], 0, 0, 0), vec4(0, m[1], 0, 0), vec4(0, 0, m[2], 0)}};
    }
    const Block3 zero = {{all4(0), all4(0), all4(0)}};
    for (int i = lu->count; i < lu->count + 2 * lu->below + 3; i++) lu->blocks[i] = zero;
    for (int i = 0; i < s->group_count; i++)
        for (int half = 0; half < GROUP_PAIRS; half++) {
            const InteriorPair *pair = &s->pairs[GROUP_PAIRS * i + half];
            Vec4 columns[4];
            stiffness(&s->groups[i], pair, 2 * half, columns);
            add_stiffness(lu->blocks, pair, columns);
        }
}

static inline double dot4(Vec4 x, Vec4 y) { return sum4(x * y); }

/* J x, for the change of velocities x. */
static void relative_changes(Interior *s, const Vec4 *x) {
    for (int i = 0; i < s->group_count; i++)
        for (int half = 0; half < GROUP_PAIRS; half++) {
            const InteriorPair *pair = &s->pairs[GROUP_PAIRS * i + half];
            const Vec4 a = x[pair->a], b = x[pair->b], by = vec4(b[0] - a[0], b[1] - a[1], b[2], a[2]);
            for (int k = 0; k < 2; k++) {
                s->groups[i].change_normal[2 * half + k] = dot4(pair->normal[k], by);
                s->groups[i].change_tangent[2 * half + k] = dot4(pair->tangent[k], by);
            }
        }
}

/* The changes of a group by the last solve, before any limit. */
typedef struct Changes {
    Vec4 l, z, t, p, q;
    Vec4 upper, lower; /* of mu l - t and mu l + t */
} Changes;

static inline Changes changes_of(const InteriorGroup *g, Vec4 second_p, Vec4 second_q) {
    Changes by;
    by.l = g->rn - g->dn * g->change_normal;
    by.z = g->change_normal + (g->normal - g->bias - g->z);
    by.t = g->rt - g->dt * g->change_tangent + g->s * by.l;
    by.upper = g->friction * by.l - by.t;
    by.lower = g->friction * by.l + by.t;
    by.p = (g->aim_tangent + second_p - g->p * by.upper) * g->upper - g->p;
    by.q = (g->aim_tangent + second_q - g->q * by.lower) * g->lower - g->q;
    return by;
}

/* The products of second order that the first solve predicts, limited to the size of the terms themselves. */
static void correct(Interior *s) {
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        const Changes by = changes_of(g, all4(0), all4(0));
        const Vec4 bound = g->friction * g->l;
        g->rn -= clamp4(by.l * by.z, larger(g->aim_normal, g->l * g->z)) * g->over_z;
        g->second_p = -clamp4(by.p * by.upper, larger(g->aim_tangent, g->p * (bound - g->t)));
        g->second_q = -clamp4(by.q * by.lower, larger(g->aim_tangent, g->q * (bound + g->t)));
        g->rt -= g->dt * (g->second_p * g->upper - g->second_q * g->lower);
        g->impulse_normal = g->l + g->rn;
        g->impulse_tangent = g->t + g->rt + g->s * g->rn;
    }
}

/* The iterate stays inside all bounds; the answer is the full step, inside the cone. */
static void advance(Interior *s) {
    const Vec4 zero = all4(0), almost = all4(1 - 1e-13);
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        const Changes by = changes_of(g, g->second_p, g->second_q);
        const Vec4 l = larger(g->l + by.l, kept * g->l), t = g->t + by.t;
        const Vec4 share = 1 - kept * (1 - magnitude(g->t) / (g->friction * g->l));
        g->answer_normal = larger(g->l + by.l, zero);
        g->answer_tangent = clamp4(t, g->friction * g->answer_normal);
        g->z = larger(g->z + by.z, kept * g->z);
        g->p = larger(g->p + by.p, kept * g->p);
        g->q = larger(g->q + by.q, kept * g->q);
        g->t = clamp4(t, smaller(share, almost) * g->friction * l);
        g->l = l;
    }
}

static inline Vec4 missing_normal(const InteriorGroup *g) {
    return smaller(g->answer_normal * g->inverse_normal, g->normal - g->bias);
}

static inline Vec4 missing_tangent(const InteriorGroup *g) {
    const Vec4 bound = g->friction * g->answer_normal;
    const Vec4 wanted = clamp4(g->answer_tangent - g->mass_tangent * g->tangent, bound);
    return (g->answer_tangent - wanted) * g->inverse_tangent;
}

static double residual(const Interior *s) {
    Vec4 sum = all4(0);
    for (int i = 0; i < s->group_count; i++) {
        const InteriorGroup *g = &s->groups[i];
        const Vec4 normal = missing_normal(g), tangent = missing_tangent(g);
        sum += g->weight * (normal * normal + tangent * tangent);
    }
    return s->contact_count > 0 ? sqrt(sum4(sum) / s->contact_count) : 0;
}

static void solve_changes(Interior *s) {
    momentum_left(s, s->changes);
    push_all(s, s->changes);
    block_lu_solve(&s->lu, s->changes);
    s->changes[s->lu.count] = all4(0);
    relative_changes(s, s->changes);
}

/* Velocities from the answer. */
static void apply_answer(Interior *s) {
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        g->impulse_normal = g->answer_normal;
        g->impulse_tangent = g->answer_tangent;
    }
    for (int k = 0; k <= s->lu.count; k++) s->changes[k] = all4(0);
    push_all(s, s->changes);
    for (int k = 0; k <= s->lu.count; k++) {
        s->changes[k] *= s->inverses[k];
        s->velocities[k] = s->start[k] + s->changes[k];
    }
    relative_changes(s, s->changes);
    for (int i = 0; i < s->group_count; i++) {
        InteriorGroup *g = &s->groups[i];
        g->normal = g->free_normal + g->change_normal;
        g->tangent = g->free_tangent + g->change_tangent;
    }
}

static double iterate(Interior *s, double target) {
    if (s->net != NULL && s->iterations < INTERIOR_NET_STEPS)
        consult(s, target);
    else if (s->net != NULL && s->iterations == INTERIOR_NET_STEPS)
        stop_consulting(s);
    linearise(s, target);
    assemble(s);
    block_lu_factor(&s->lu);
    solve_changes(s);
    correct(s);
    solve_changes(s);
    advance(s);
    apply_answer(s);
    return residual(s);
}

const InteriorKernels KERNELS = {KERNELS_NAME, block_lu_factor, block_lu_solve, iterate, residual};
