/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps with momentum: a scalar reference implementation, and the fast one of the solvers, which visits contacts in
   the order of colours (sweeps/colours.h). The solvers choose the factors. */
#pragma once
#include "common/error.h"
#include "solvers/stopping.h"
#include "sweeps/sweeps.h"

/* Scalar reference implementation: `count` sweeps over the contacts visits[contact_count]; before each sweep s > 0 the
   extrapolation by factors[s] >= 0. `before`: work space, a solution of the same size. sweeps_run_momentum gives the
   same bits. */
void momentum_solve_scalar(const ContactProblem *problem, const int32_t *visits, const float *factors, int count,
                           ContactSolution *before, ContactSolution *solution);

/* The hand-tuned factor before sweep s of `count`, counted from 0: s / (s + 1.4), at most 1 - 7 / (15 + count). The
   limit is lower for few sweeps, as they have no time to correct the overshoot of a large factor. Tuned on launches of
   the stack and the pyramids together. */
float momentum_factor_tuned(int sweep, int count);

/* The hand-tuned factors of `count` sweeps; the caller frees them. NULL when memory is short. */
float *momentum_factors_make(int count);

/* Zero-initialise; arrays grow and are reused. */
typedef struct Momentum {
    Sweeps sweeps;
    ContactSolution before; /* work space of the scalar implementation */
    size_t body_capacity, contact_capacity;
    StoppingRule rule;
    float *more_factors; /* [rule.more] */
} Momentum;

/* Sweeps by the rule after those before; factors[rule->more]. The remaining error has long waves, such as a heavy bomb
   on a whole stack, which need momentum with large factors: so this is one run of sweeps with momentum, not many short
   ones. False when memory is short. */
bool momentum_run_more(Sweeps *sweeps, const ContactProblem *problem, const StoppingRule *rule, const float *factors);

void momentum_free(Momentum *momentum);

/* Uses the fast sweeps with the stopping rule, or `count` of the scalar implementation if these end with a NaN or
   infinite number. */
bool momentum_solve(Momentum *momentum, const ContactProblem *problem, const float *factors, int count,
                    ContactSolution *solution, Error *error);
