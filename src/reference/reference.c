/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NNCG: nonsmooth nonlinear conjugate gradients over sweeps of projected Gauss-Seidel.

   One sweep of projected Gauss-Seidel over all contacts, in double, maps impulses p to p'. Its step serves as the
   gradient of a Fletcher-Reeves conjugate gradient method:

       g = p - p',  beta = |g|^2 / |g of the previous sweep|^2,  d' = beta d - g,  p = p' + beta d.

   Velocities are linear in the impulses, so the same recursion holds for them. Source: Silcowitz, Niebuhr, Poulsen,
   Erleben, "A Nonsmooth Nonlinear Conjugate Gradient Method for Interactive Contact Force Problems" (2010). The paper
   restarts (d' = -g, p = p') if beta > 1. This implementation restarts if a step points against d, and limits beta to
   1: redundant contacts drift at constant speed, beta = 1, until one slips or separates, and the published rule stops
   every second step of that (O'Donoghue, Candes, "Adaptive Restart for Accelerated Gradient Schemes", 2015). A third to
   a tenth of the sweeps for the same error.

   Fails by slow convergence if such a drift is long; the residual shows it. */
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
    bool lanes = !r->scalar && sweeps_can(SWEEP_AVX2);
    return lanes ? reference_sweep_avx2(r, beta) : reference_sweep_scalar(r, beta);
}

/* Ends with a plain sweep from the current impulses: its change is their residual, and the impulses before it are the
   result. */
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
    reference_store(reference, problem);
    return true;
}

bool reference_residual(Reference *reference, const ContactProblem *problem, const ContactImpulse *impulses,
                        double *residual, Error *error) {
    if (!reference_load(reference, problem)) return error_memory(error, "reference");
    reference_start(reference, problem, impulses);
    *residual = sweep(reference, 0).change;
    return true;
}
