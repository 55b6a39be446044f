/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "interior_training/unrolled_iteration.h"

/* interior_net.h describes them. */
static void inputs_of(Tape *t, const UnrolledNodes *n, TapeId inputs[INTERIOR_NET_INPUTS]) {
    const TapeId scale = tape_scale(t, 0.5, tape_one(t, TAPE_LOG2, n->target));
    const TapeId log_l = tape_one(t, TAPE_LOG2, tape_multiply(t, n->l, n->inverse_normal));
    const TapeId log_z = tape_one(t, TAPE_LOG2, n->z);
    const TapeId gap = tape_divide(t, tape_subtract(t, n->normal, n->bias), n->z);
    inputs[0] = tape_scale(t, 0.25, tape_subtract(t, log_l, scale));
    inputs[1] = tape_scale(t, 0.25, tape_subtract(t, log_z, scale));
    inputs[2] = tape_clamp(t, tape_subtract(t, gap, n->one), tape_number(t, INTERIOR_NET_INPUT));
}

/* bias + weights inputs */
static TapeId row(Tape *t, const TapeId *weights, TapeId bias, const TapeId *inputs, int count) {
    TapeId sum = bias;
    for (int i = 0; i < count; i++) sum = tape_add(t, sum, tape_multiply(t, weights[i], inputs[i]));
    return sum;
}

static void globals_of(Tape *t, const UnrolledNodes *n, int step, TapeId globals[INTERIOR_NET_GLOBALS]) {
    const TapeId scale = tape_scale(t, 0.5, tape_one(t, TAPE_LOG2, n->target));
    const TapeId first = tape_scale(t, 0.5, tape_one(t, TAPE_LOG2, n->first_target));
    const TapeId residual = tape_one(t, TAPE_LOG2, tape_add(t, n->estimate, tape_number(t, INTERIOR_NET_SMALL)));
    const TapeId gap = tape_number(t, INTERIOR_NET_INPUT);
    globals[0] = n->one;
    globals[1] = tape_number(t, step == 0);
    globals[2] = tape_clamp(t, tape_scale(t, 0.125, tape_subtract(t, scale, first)), gap);
    globals[3] = tape_clamp(t, tape_scale(t, 0.25, tape_subtract(t, residual, scale)), gap);
}

static TapeId bias_of(Tape *t, const TapeId *weights, int stride, const TapeId *globals) {
    TapeId sum = weights[0];
    for (int i = 1; i < INTERIOR_NET_GLOBALS; i++)
        sum = tape_add(t, sum, tape_multiply(t, weights[i * stride], globals[i]));
    return sum;
}

void unrolled_network(Tape *t, const UnrolledNodes *n, int step, TapeId outputs[INTERIOR_NET_OUTPUTS]) {
    TapeId inputs[INTERIOR_NET_INPUTS], globals[INTERIOR_NET_GLOBALS];
    inputs_of(t, n, inputs);
    globals_of(t, n, step, globals);
    TapeId hidden[INTERIOR_NET_HIDDEN];
    for (int i = 0; i < INTERIOR_NET_HIDDEN; i++) {
        const TapeId x = row(t, n->weights + INTERIOR_NET_HIDDEN_WEIGHTS + i * INTERIOR_NET_INPUTS,
                             bias_of(t, n->weights + INTERIOR_NET_HIDDEN_BIASES + i, INTERIOR_NET_HIDDEN, globals),
                             inputs, INTERIOR_NET_INPUTS);
        hidden[i] = tape_larger(t, x, tape_scale(t, INTERIOR_NET_LEAK, x));
    }
    for (int i = 0; i < INTERIOR_NET_OUTPUTS; i++) {
        const TapeId x = row(t, n->weights + INTERIOR_NET_OUTPUT_WEIGHTS + i * INTERIOR_NET_HIDDEN,
                             bias_of(t, n->weights + INTERIOR_NET_OUTPUT_BIASES + i, INTERIOR_NET_OUTPUTS, globals),
                             hidden, INTERIOR_NET_HIDDEN);
        outputs[i] = tape_one(t, TAPE_POWER2, tape_clamp(t, x, tape_number(t, INTERIOR_NET_LIMIT)));
    }
}
