/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The network of interior-net (network/interior_net.h) on a group of contacts. Included by interior_code.h. All weights
   zero multiply by 1: the bits are those without a network. */
#include "interior/interior_contacts.h"

typedef unsigned long long Bits4 __attribute__((vector_size(32), aligned(16), may_alias));

/* interior_net_log2() and interior_net_power2() of four numbers. */
static inline Vec4 log2_of(Vec4 x) {
    return ((Vec4)(((Bits4)x >> 12) | (Bits4)all4(0x1p52)) - 0x1p52) * 0x1p-40 - 1023;
}
static inline Vec4 power2_of(Vec4 x) { return (Vec4)((Bits4)((x + 1023) * 0x1p40 + 0x1p52) << 12); }

/* What is the same for all contacts of an iteration. */
typedef struct InteriorNetStep {
    const double *hidden, *output;
    double hidden_biases[INTERIOR_NET_HIDDEN], output_biases[INTERIOR_NET_OUTPUTS];
    double scale; /* log2 tau */
} InteriorNetStep;

static void biases_of(const double *weights, int count, const double globals[INTERIOR_NET_GLOBALS], double *biases) {
    for (int i = 0; i < count; i++) {
        biases[i] = 0;
        for (int k = 0; k < INTERIOR_NET_GLOBALS; k++) biases[i] += globals[k] * weights[k * count + i];
    }
}

static double clamp_number(double x, double limit) { return x < -limit ? -limit : x < limit ? x : limit; }

static InteriorNetStep consult_begin(const Interior *s, double target) {
    const double *weights = s->net->weights, scale = 0.5 * interior_net_log2(target);
    const double globals[INTERIOR_NET_GLOBALS] = {
        1, s->iterations == 0,
        clamp_number((scale - 0.5 * interior_net_log2(s->first_target)) * 0.125, INTERIOR_NET_INPUT),
        clamp_number((interior_net_log2(s->residual + INTERIOR_NET_SMALL) - scale) * 0.25, INTERIOR_NET_INPUT)};
    InteriorNetStep step = {.hidden = weights + INTERIOR_NET_HIDDEN_WEIGHTS,
                            .output = weights + INTERIOR_NET_OUTPUT_WEIGHTS,
                            .scale = scale};
    biases_of(weights + INTERIOR_NET_HIDDEN_BIASES, INTERIOR_NET_HIDDEN, globals, step.hidden_biases);
    biases_of(weights + INTERIOR_NET_OUTPUT_BIASES, INTERIOR_NET_OUTPUTS, globals, step.output_biases);
    return step;
}

/* In pairs: a chain of sums would take as long as their latency. */
static inline Vec4 sum_of(const Vec4 *x, const double *by, int count) {
    Vec4 sum = x[0] * by[0] + x[1] * by[1];
    for (int k = 2; k < count; k += 2) sum += k + 1 < count ? x[k] * by[k] + x[k + 1] * by[k + 1] : x[k] * by[k];
    return sum;
}

/* Moves l, t and z, and leaves the factor of the aim in aim_normal. */
static inline void consult_group(const InteriorNetStep *net, InteriorGroup *g) {
    const Vec4 inputs[INTERIOR_NET_INPUTS] = {(log2_of(g->l * g->inverse_normal) - net->scale) * 0.25,
                                              (log2_of(g->z) - net->scale) * 0.25,
                                              clamp4((g->normal - g->bias) / g->z - 1, all4(INTERIOR_NET_INPUT))};
    Vec4 hidden[INTERIOR_NET_HIDDEN], factors[INTERIOR_NET_OUTPUTS];
    for (int i = 0; i < INTERIOR_NET_HIDDEN; i++) {
        const Vec4 x = sum_of(inputs, net->hidden + (ptrdiff_t)INTERIOR_NET_INPUTS * i, INTERIOR_NET_INPUTS) +
                       net->hidden_biases[i];
        hidden[i] = larger(x, x * INTERIOR_NET_LEAK);
    }
    for (int i = 0; i < INTERIOR_NET_OUTPUTS; i++) {
        const Vec4 x = sum_of(hidden, net->output + (ptrdiff_t)INTERIOR_NET_HIDDEN * i, INTERIOR_NET_HIDDEN) +
                       net->output_biases[i];
        factors[i] = power2_of(clamp4(x, all4(INTERIOR_NET_LIMIT)));
    }
    g->l *= factors[0];
    g->t *= factors[0];
    g->z *= factors[1];
    g->aim_normal = factors[2];
}

/* A pass of its own: the processor overlaps the groups, whose chains of operations are long. */
static void consult(Interior *s, double target) {
    const InteriorNetStep net = consult_begin(s, target);
    for (int i = 0; i < s->group_count; i++) consult_group(&net, &s->groups[i]);
}
