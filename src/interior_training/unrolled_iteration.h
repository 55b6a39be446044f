/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One iteration of interior/interior_code.h on a tape, and the network in front of it. */
#pragma once
#include "interior_training/unrolled_interior.h"

/* The problem and the iterate. */
typedef struct UnrolledNodes {
    TapeId mass_normal, mass_tangent, inverse_normal, inverse_tangent, friction, bias;
    TapeId masses, inverses, start, one, zero;
    TapeId weights[INTERIOR_NET_WEIGHTS];
    TapeId l, t, z, p, q, normal, tangent, velocities, answer_normal, answer_tangent;
    TapeId first_target, target, estimate;
} UnrolledNodes;

/* The iterate and the answer after the iteration `step` (from 0), towards n->target. */
void unrolled_iterate(UnrolledInterior *u, UnrolledNodes *n, int step);

/* The network's factors of l and t, of z, and of the aim, before the iteration `step`. */
void unrolled_network(Tape *t, const UnrolledNodes *n, int step, TapeId outputs[INTERIOR_NET_OUTPUTS]);

static inline TapeId tape_square(Tape *t, TapeId x) { return tape_multiply(t, x, x); }
