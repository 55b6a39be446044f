/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sweeps with momentum, which visit contacts in the order of colours (methods/sweeps.h). The solvers choose the
   factors. Their scalar reference implementation is that of the tests (tests/methods/momentum_scalar.h). */
#pragma once
#include "base/base.h"
#include "engine/engine.h"
#include "methods/islands.h"
#include "methods/stopping.h"
#include "methods/sweeps.h"

#include <stdbool.h>
#include <stdint.h>

/* The factor before sweep s, counted from 0: 1 - 7 / (15 + s), and 0 before the first. It does not depend on the number
   of sweeps, so that more sweeps continue fewer. Tuned on launches of the stack and the pyramids together. */
float momentum_factor(int sweep);

/* The hand-tuned factors of `count` sweeps; the caller frees them. NULL when memory is short. */
float *momentum_factors_make(int count);

typedef struct MomentumIsland MomentumIsland;

/* Zero-initialise; arrays grow and are reused. */
typedef struct Momentum {
    Sweeps sweeps;
    StoppingRule rule;   /* its k does not count */
    float *more_factors; /* [rule.more] */
    const ContactProblem *problem;
    bool watched;            /* its islands have courses */
    MomentumIsland *courses; /* [sweeps.groups] */
    bool *chosen;            /* [sweeps.groups] */
    float *of_pairs;         /* [sweeps.pair_count] what was last measured */
    float *factors;          /* [sweeps of a block, sweeps.groups] */
    ArrayBlock arrays;
    Islands islands;
} Momentum;

void momentum_free(Momentum *momentum);

/* momentum->sweeps have begun with this problem, which must stay until the end. False when memory is short. */
bool momentum_begin(Momentum *momentum, const ContactProblem *problem);

/* `count` sweeps with factors[count]. Each island's residual is not above the least of those that 16, 32, ... of
   them left; where contacts slide so that visits overshoot, that 8, 16, ... of them left. False when memory is
   short. */
bool momentum_run(Momentum *momentum, const float *factors, int count);

/* Sweeps by the rule after those before; factors[rule->more]. The remaining error has long waves, such as a heavy bomb
   on a whole stack, which need momentum with large factors: so this is one run of sweeps with momentum, not many short
   ones. Where it ends by rule->more, no island's residual is above the least, before or on the way. False when memory
   is short. */
bool momentum_run_more(Momentum *momentum, const StoppingRule *rule, const float *factors);

/* Stores the solution, which adds no energy; that of the warm start if it is NaN or infinite. False when memory is
   short. */
bool momentum_end(Momentum *momentum, ContactSolution *solution);

/* All of these, from the warm start, with the momentum's rule. */
bool momentum_solve(Momentum *momentum, const ContactProblem *problem, const float *factors, int count,
                    ContactSolution *solution, Error *error);
