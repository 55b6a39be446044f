/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NNCG: nonsmooth nonlinear conjugate gradients over sweeps of projected Gauss-Seidel.

   A sweep over all contacts (the map of sequential impulses, in double) turns impulses p into p'. Its step is taken
   as a steepest descent, and the steps are made conjugate as Fletcher and Reeves do:

       g = p - p',  beta = |g|^2 / |g of the sweep before|^2,  d' = beta d - g,  p = p' + beta d.

   Velocities are linear in the impulses: theirs is the same recursion. Source: Silcowitz, Niebuhr, Poulsen, Erleben,
   "A Nonsmooth Nonlinear Conjugate Gradient Method for Interactive Contact Force Problems" (2010). They begin anew
   (d' = -g, p = p') where beta > 1. Here that is done where a step turns against d, and beta is at most 1: contacts
   that share a load in more than one way drift at constant speed, beta = 1, until one slips or parts, and the
   published rule stops every second step of that (O'Donoghue, Candes, "Adaptive Restart for Accelerated Gradient
   Schemes", 2015). A third to a tenth of the sweeps for the same error.

   Fails slowly where such a drift is long; the residual says so. */
#include "reference/reference_units.h"
#include "sweeps/sweeps.h"

#include <string.h>

static void swap_sums(Reference *r) {
    ReferenceNumbers *sums = r->sums;
    r->sums = r->sums_before;
    r->sums_before = sums;
}

static ReferenceSweep sweep(Reference *r, double beta) {
    swap_sums(r);
    r->sweeps++;
    bool lanes = !r->plain && sweeps_can(SWEEP_AVX2);
    return lanes ? reference_sweep_avx2(r, beta) : reference_sweep_plain(r, beta);
}

/* Ends with a sweep that began where another left off: its change is the residual of what the first one left, and
   that is kept. */
static void iterate(Reference *r, double tolerance, int max_sweeps) {
    double before = 0, beta = 0;
    for (;;) {
        bool from_sweep = r->sweeps > 0 && beta == 0;
        ReferenceSweep now = sweep(r, beta);
        bool converged = !(now.change > tolerance);
        if (from_sweep && (converged || r->sweeps >= max_sweeps)) {
            r->residual = now.change;
            swap_sums(r);
            return;
        }
        bool last_is_next = converged || r->sweeps + 1 >= max_sweeps;
        beta = last_is_next || !(now.along > 0) ? 0 : now.squared < before ? now.squared / before : 1;
        before = now.squared;
    }
}

bool reference_solve(Reference *reference, const ContactProblem *problem, double tolerance, int max_visits,
                     const ContactImpulse *start, Error *error) {
    if (!reference_load(reference, problem)) return error_memory(error, "reference");
    reference_start(reference, problem, start);
    iterate(reference, tolerance, problem->contact_count > 0 ? max_visits / problem->contact_count : 0);
    reference_hand_out(reference, problem);
    return true;
}

bool reference_residual(Reference *reference, const ContactProblem *problem, const ContactImpulse *impulses,
                        double *residual, Error *error) {
    if (!reference_load(reference, problem)) return error_memory(error, "reference");
    reference_start(reference, problem, impulses);
    *residual = sweep(reference, 0).change;
    return true;
}
