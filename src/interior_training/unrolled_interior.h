/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The iterations of interior/interior_code.h with the network of interior-net, on a tape: derivatives of a loss of their
   answers with respect to the weights. The adjoint of a solve A x = y is one solve with the transposed matrix,
   y* = A^-T x*, A* = -y* x^T; A depends on D_n, D_t and s of the contacts.
   Source: Giles, "Collected Matrix Derivative Results for Forward and Reverse Mode Algorithmic Differentiation"
   (2008). */
#pragma once
#include "interior/interior.h"
#include "interior_training/tape.h"
#include "network/interior_net.h"
#include "reference/reference.h"

enum { UNROLLED_ITERATIONS_MAX = 8 };

/* The loss of a problem: the mean over the iterations `first` .. `last` (from 1) of log(e + floor) + tail e, where e is
   the error of the iteration's answer (reference/solution_error.h). */
typedef struct InteriorTask {
    int first, last;
    double floor; /* m/s: accuracy beyond it counts little */
    double tail;  /* s/m: weight of large errors, which the mean of logarithms would neglect */
} InteriorTask;

/* The work space of a thread. Zero-initialise; arrays grow and are reused. */
typedef struct UnrolledInterior {
    Sweeps sweeps;
    Interior interior;
    Tape tape;
    struct UnrolledFactor {
        TapeId dn, dt, s;
    } factors[UNROLLED_ITERATIONS_MAX];
    int factor_count, transposed;           /* transposed: the factor whose transposed matrix is factorized; -1: none */
    double errors[UNROLLED_ITERATIONS_MAX]; /* m/s, of the answers of the last call */
} UnrolledInterior;

void unrolled_interior_free(UnrolledInterior *unrolled);

/* Adds the loss's derivatives with respect to the weights to slopes[INTERIOR_NET_WEIGHTS] (NULL: not computed). False
   when memory is short. */
bool unrolled_interior_loss(UnrolledInterior *unrolled, const ContactProblem *problem,
                            const ReferenceVelocity *reference, const double *weights, const InteriorTask *task,
                            double *loss, double *slopes);
